#pragma once

namespace misfit::tools {

/// To be called before anything is computed or opened. Freed memory stays with the process, since fresh pages cost as much as
/// the work on them; and HOME is set, without which casacore ends.
void prepare_process();

}  // namespace misfit::tools
