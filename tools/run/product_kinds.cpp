#include "tools/run/product_kinds.h"

#include <algorithm>

#include "imager/taylor/taylor_expansion.h"
#include "tools/run/primary_beam_stage.h"

namespace misfit::tools {
namespace {

/// An image for each of `count` Taylor terms.
void add(std::vector<ProductKind>& kinds, const ProductKind& kind, int count, int terms, const std::string& end = "") {
  for (int order = 0; order < count; ++order) {
    kinds.push_back(kind);
    if (terms > 1) kinds.back().term = {order, terms};
    kinds.back().name = product_name(kind.name, kinds.back().term, end);
  }
}

/// Adds spectral indices and, for three terms, curvatures, for which casacore has no name of its own.
void add_spectra(std::vector<ProductKind>& kinds, int terms, const std::string& end) {
  const auto add = [&](const std::string& name) {
    kinds.push_back(
        {.name = name, .unit = "", .each_stokes = false, .completed = Completed::with_beam, .quantity = "Spectral Index"});
  };
  add("alpha" + end);
  if (end.empty()) add("alpha.error");
  if (terms > 2) add("beta" + end);
}

}  // namespace

ProductChoice ProductChoice::of(const ImageOptions& o) {
  const bool all = o.all_products();
  return {.terms = o.taylor.nterms,
          .cleaned = o.clean.runs(),
          .masked = o.clean.runs() && (all || o.masks_clean()),
          .restored = all || o.clean.runs(),
          .primary_beam = o.primary_beam.wanted() || o.makes_mosaic(),
          .corrected = o.primary_beam.pbcor,
          .weights = all,
          .mosaic = o.makes_mosaic()};
}

std::string product_name(const std::string& kind, const imager::TaylorTerm& term, const std::string& end) {
  return kind + (term.several() ? ".tt" + std::to_string(term.order) : "") + end;
}

std::vector<ProductKind> product_kinds(const ProductChoice& choice) {
  std::vector<ProductKind> kinds;
  const int n = choice.terms;
  add(kinds, {.name = "psf", .each_stokes = false}, 2 * n - 1, n);
  add(kinds, {.name = "residual", .masked_by_beam = true}, n, n);
  if (choice.primary_beam)
    add(kinds, {.name = "pb", .unit = "", .each_stokes = false, .beam = false, .completed = Completed::first},
        choice.mosaic ? 1 : n, n);
  if (choice.mosaic) add(kinds, {.name = "weight", .unit = "", .each_stokes = false, .beam = false}, 1, n);
  if (choice.corrected) add(kinds, {.name = "image", .completed = Completed::with_beam}, n, n, ".pbcor");
  if (choice.weights) add(kinds, {.name = "sumwt", .unit = "", .beam = false, .one_pixel = true}, 2 * n - 1, n);
  if (choice.restored) add(kinds, {.name = "image", .completed = Completed::with_beam, .masked_by_beam = true}, n, n);
  if (!choice.cleaned) return kinds;
  add(kinds, {.name = "model", .unit = "Jy/pixel", .beam = false}, n, n);
  if (choice.masked) kinds.push_back({.name = "mask", .unit = "", .beam = false});
  if (n > 1) add_spectra(kinds, n, "");
  if (n > 1 && choice.corrected) add_spectra(kinds, n, ".pbcor");
  return kinds;
}

std::vector<std::string> product_names(const ProductChoice& choice) {
  std::vector<std::string> names;
  for (const ProductKind& kind : product_kinds(choice)) names.push_back(kind.name);
  return names;
}

std::vector<std::string> all_product_names() {
  ProductChoice choice{
      .cleaned = true, .masked = true, .restored = true, .primary_beam = true, .corrected = true, .weights = true};
  std::vector<std::string> names;
  for (const int terms : {1, imager::most_taylor_terms})
    for (const bool mosaic : {false, true}) {
      choice.terms = terms;
      choice.mosaic = mosaic;
      for (const std::string& name : product_names(choice))
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  return names;
}

int product_planes(const ProductChoice& choice, int stokes) {
  int planes = 0;
  for (const ProductKind& kind : product_kinds(choice))
    if (!kind.one_pixel) planes += kind.each_stokes ? stokes : 1;
  return planes;
}

}  // namespace misfit::tools
