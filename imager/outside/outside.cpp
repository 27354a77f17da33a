#include "imager/outside/outside.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace misfit::imager {
namespace {

/// Components about a bright one.
struct Group {
  int row = 0;
  int column = 0;
  double flux_jy = 0;
  double positive_jy = 0;  ///< of these the rows and columns are the mean
  double rows_jy = 0;
  double columns_jy = 0;

  void add(const Component& c) {
    flux_jy += c.flux_jy;
    const double positive = std::max(c.flux_jy, 0.0);
    positive_jy += positive;
    rows_jy += positive * (c.row - row);
    columns_jy += positive * (c.column - column);
  }
  DirectionCosines position(const ImageGeometry& g) const {
    DirectionCosines at = g.at(row, column);
    if (positive_jy == 0) return at;
    at.l -= columns_jy / positive_jy * g.cell_rad;
    at.m += rows_jy / positive_jy * g.cell_rad;
    return at;
  }
};

std::vector<Group> groups_of(std::vector<Component> components) {
  std::stable_sort(components.begin(), components.end(),
                   [](const Component& a, const Component& b) { return std::abs(a.flux_jy) > std::abs(b.flux_jy); });
  std::vector<Group> groups;
  for (const Component& c : components) {
    constexpr int together = 3;
    const auto near = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return std::abs(g.row - c.row) <= together && std::abs(g.column - c.column) <= together;
    });
    if (near != groups.end()) {
      near->add(c);
      continue;
    }
    groups.push_back({c.row, c.column});
    groups.back().add(c);
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
    if (group.flux_jy < least_jy || !lies_outside(at, image, 2 * found_in.cell_rad)) continue;
    constexpr double lobe_pixels = 4;  // a main lobe upon the border may have its peak beyond
    sources.push_back(
        {{at, group.flux_jy}, group.flux_jy * aliases.of(at), lies_outside(at, found_in, -lobe_pixels * found_in.cell_rad)});
  }
  std::stable_sort(sources.begin(), sources.end(),
                   [](const OutsideSource& a, const OutsideSource& b) { return a.alias_jy > b.alias_jy; });
  return sources;
}

}  // namespace misfit::imager
