#pragma once

namespace CLI {
class App;
}

namespace misfit::tools {

/// What is to be made of the primary beam, as typed.
struct TypedPrimaryBeam {
  bool pbcor = false;
  double pblimit = 0;  ///< 0: not given; its sign makes no difference
  bool pb = false;     ///< .pb is wanted where antennas have a simple beam

  bool wanted() const { return pb || required(); }
  /// Whether a run without it is of no use: with --pbcor or --pblimit, but for --pb.
  bool required() const { return pbcor || (pblimit != 0 && !pb); }
  /// The value below which images have no values.
  double limit() const;
};

void declare(CLI::App& command, TypedPrimaryBeam& options);

/// Throws as check(const ImageOptions&) does.
void check(const TypedPrimaryBeam& options);

}  // namespace misfit::tools
