#pragma once

namespace misfit::tools {

/// The configuration of the build; "" stands for none.
struct BuildFacts {
  const char* commit;      ///< of git; none where the sources are no checkout
  const char* compiler;    ///< name and version
  const char* build_type;  ///< CMake's
  const char* sanitizers;  ///< as in -fsanitize=
};

extern const BuildFacts build_facts;

}  // namespace misfit::tools
