#include "tools/formats/sky.h"

#include <array>

namespace misfit::tools {
namespace {

struct CardEntry {
  int x, y;  ///< cells to the east and to the north
  int flux_jy;
};

constexpr std::array<CardEntry, 34> card{{
    {0, 0, 2},       {0, 15, 2},     {-120, 180, 2}, {150, -150, 2}, {300, 90, 2},    {-90, 300, 2},  {90, -90, 1},
    {-90, 90, 1},    {-90, -90, 1},  {180, 90, 1},   {180, 180, 1},  {180, -180, 1},  {-180, 180, 1}, {-180, -180, 1},
    {270, 0, 1},     {0, -270, 1},   {-270, 0, 1},   {0, 270, 1},    {0, 330, 1},     {330, 0, 1},    {0, -330, 1},
    {-330, 0, 1},    {270, 270, 1},  {270, -270, 1}, {-270, 270, 1}, {-270, -270, 1}, {390, 390, 3},  {390, -390, 3},
    {-390, -390, 3}, {-390, 390, 3}, {345, 0, 2},    {-345, 0, 2},   {0, -345, 2},    {0, 345, 2},
}};

}  // namespace

std::vector<imager::Source> test_card(double cell_rad) {
  std::vector<imager::Source> sources;
  for (const auto& [x, y, flux_jy] : card) sources.push_back({{x * cell_rad, y * cell_rad}, double(flux_jy)});
  return sources;
}

}  // namespace misfit::tools
