// States of CLEAN, as --restart reads them. Inputs lack the sum at the end of the file, so that what is behind it is reached.
#include <nlohmann/json.hpp>

#include "tests/fuzz/fuzzing.h"
#include "tools/formats/clean_state_file.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

/// FNV-1a, little-endian, which ends a state.
std::string with_sum(const std::uint8_t* data, std::size_t size) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (std::size_t i = 0; i < size; ++i) sum = (sum ^ data[i]) * 0x100000001b3;
  std::string file(reinterpret_cast<const char*>(data), size);
  for (int byte = 0; byte < 8; ++byte) file += static_cast<char>(sum >> (8 * byte));
  return file;
}

void require_promises(const InputFile& file, const std::vector<double>& scales) {
  const tools::CleanStateOwner owner{"1", {{"gain", "0.1"}, {"mask", ""}}, 7, 1, {4, 3, scales}};
  const auto read = read_or_refused(file.path(), [&] { return tools::read_clean_state(file.path(), owner); });
  if (!read) return;
  const imager::CleanState* const state = &read->state;
  if (read->changed.empty())
    require(state->now < state->cycles.size() && state->best < state->cycles.size(), "a state has the cycles that it names");
  require(state->mask.allowed.pixel.empty() || state->mask.allowed.pixel.size() == 12, "a mask has the image's pixels");
  for (const imager::ComponentModel* model : {&state->model, &state->best_model}) {
    require(model->width() == 4 && model->height() == 3 && model->scale_pixels() == scales, "a model is of the image");
    for (const imager::Component& c : model->components())
      require(c.row >= 0 && c.row < 3 && c.column >= 0 && c.column < 4, "components lie within the image");
  }
  const std::string again = (file.folder() / "again.state").string();
  tools::write_clean_state(again, *state, owner);
  const imager::CleanState reread = tools::read_clean_state(again, owner).state;
  require(reread.cycles.size() == state->cycles.size() && reread.mask.allowed.pixel == state->mask.allowed.pixel &&
              reread.model.components().size() == state->model.components().size(),
          "a state that was written is read again");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content = with_sum(data, size);
  const InputFile file(reinterpret_cast<const std::uint8_t*>(content.data()), content.size(), "out.clean.state");
  for (const std::vector<double>& scales : {std::vector<double>{0}, {0, 3.7}}) require_promises(file, scales);
  return 0;
}
