#pragma once

#include <vector>

namespace misfit::tools {

/// The cost of a choice, and its error.
struct CostAndError {
  double cost = 0;
  double error = 0;
  double cost_noise = 0;   ///< standard error of the cost, as a part of it
  double error_noise = 0;  ///< of the error
};

/// The ratio from which on two numbers differ by more than noise, which is given as parts of them: 1 + two standard errors of
/// the ratio.
double distinct_ratio(double noise, double other_noise);

/// The best choices where numbers differ only if by more than noise. a covers b if it is not clearly dearer nor clearly less
/// exact, and beats it if one of both is clearly better besides. Again and again the most exact of the choices left that none
/// of them beats is put on the front, the first alone of equals, and all that it covers are left out. Thus
///  - one on the front covers each that is not on it;
///  - of two on the front, one is clearly cheaper and the other clearly more exact: the later was not covered, and did not
///  beat;
///  - of a chain in which each is the next but for noise, some stay, as far apart as noise hides, and never none;
///  - without noise it is the Pareto front.
/// It rests on there always being one that none left beats. Where noise is the same for all, that is the one with the least
/// log(cost)/log(clear ratio of costs) + log(error)/log(clear ratio of errors), since to beat is to have less of it. Where
/// noise differs some may beat each other in a circle; then the most exact of them is taken. Costs known to no better than a
/// tenth are treated as though they were, lest all be equal. Choices that are not finite are not on the front.
std::vector<bool> pareto_front(const std::vector<CostAndError>& of);

}  // namespace misfit::tools
