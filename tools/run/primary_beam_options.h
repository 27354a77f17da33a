#pragma once

namespace CLI {
class App;
}

namespace misfit::tools {

/// What is to be made of the primary beam, as typed.
struct TypedPrimaryBeam {
  bool pbcor = false;
  double pblimit = 0;  ///< 0: not given; its sign makes no difference

  /// Whether one is wanted: with --pbcor or --pblimit.
  bool wanted() const { return pbcor || pblimit != 0; }
  /// The value below which images have no values.
  double limit() const;
};

void declare(CLI::App& command, TypedPrimaryBeam& options);

/// Throws as check(const ImageOptions&) does.
void check(const TypedPrimaryBeam& options);

}  // namespace misfit::tools
