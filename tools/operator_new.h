#pragma once

namespace misfit::tools {

/// To be called when main begins: a program that gets no memory before that, while its libraries are loaded, says so and ends,
/// since nobody catches what is thrown then.
void begin_to_throw_bad_alloc() noexcept;

}  // namespace misfit::tools
