#pragma once

namespace misfit::tools {

/// To be called before anything is computed or opened: what the heap gives back stays with the process, since fresh pages are
/// as dear as what is done with them; and casacore, which ends where there is no HOME, finds one.
void prepare_process();

}  // namespace misfit::tools
