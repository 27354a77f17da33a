#include "imager/outside/outside.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace misfit::imager {
namespace {

constexpr double place_pixels = 0.5;  ///< to which places are known

/// Components about a bright one.
struct Group {
  Component brightest;
  double flux_jy = 0;
  double like_jy = 0;  ///< of the components of the brightest one's sign; `row` and `column` are their means
  double rows_jy = 0;
  double columns_jy = 0;

  /// True if a fainter component is part of it: a neighbour, or one of the components of a source between pixels, which are the
  /// fainter the farther off they are.
  bool has(const Component& c) const {
    const int apart = std::max(std::abs(brightest.row - c.row), std::abs(brightest.column - c.column));
    const double part = std::abs(c.flux_jy / like_jy);
    return apart <= 1 || (apart <= 3 && part < 0.3) || (apart <= 8 && part < 0.02);
  }
  void add(const Component& c) {
    flux_jy += c.flux_jy;
    if ((c.flux_jy < 0) != (brightest.flux_jy < 0)) return;
    like_jy += c.flux_jy;
    rows_jy += c.flux_jy * (c.row - brightest.row);
    columns_jy += c.flux_jy * (c.column - brightest.column);
  }
  DirectionCosines position(const ImageGeometry& g) const {
    const DirectionCosines at = g.at(brightest.row, brightest.column);
    return {at.l - columns_jy / like_jy * g.cell_rad, at.m + rows_jy / like_jy * g.cell_rad};
  }
};

std::vector<Group> groups_of(std::vector<Component> components) {
  std::stable_sort(components.begin(), components.end(),
                   [](const Component& a, const Component& b) { return std::abs(a.flux_jy) > std::abs(b.flux_jy); });
  std::vector<Group> groups;
  for (const Component& c : components) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.has(c); });
    if (group == groups.end()) group = groups.insert(group, Group{c});
    group->add(c);
  }
  return groups;
}

bool lies_outside(DirectionCosines at, const ImageGeometry& image, double margin_rad) {
  const double l = (image.centre.l - at.l) / image.cell_rad + image.centre_column();
  const double m = (at.m - image.centre.m) / image.cell_rad + image.centre_row();
  const double margin = margin_rad / image.cell_rad;
  return l < -margin || m < -margin || l > image.width - 1 + margin || m > image.height - 1 + margin;
}

}  // namespace

std::vector<OutsideSource> sources_outside(const std::vector<Component>& components, const ImageGeometry& found_in,
                                           const ImageGeometry& image, const AliasLevels& aliases, double least_jy) {
  std::vector<OutsideSource> sources;
  for (const Group& group : groups_of(components)) {
    const DirectionCosines at = group.position(found_in);
    if (std::abs(group.flux_jy) < least_jy || !lies_outside(at, image, place_pixels * found_in.cell_rad)) continue;
    constexpr double lobe_pixels = 4;  // a main lobe upon the border may have its peak beyond
    sources.push_back({{at, group.flux_jy},
                       std::abs(group.flux_jy) * aliases.of(at),
                       lies_outside(at, found_in, -lobe_pixels * found_in.cell_rad)});
  }
  std::stable_sort(sources.begin(), sources.end(),
                   [](const OutsideSource& a, const OutsideSource& b) { return a.alias_jy > b.alias_jy; });
  return sources;
}

}  // namespace misfit::imager
