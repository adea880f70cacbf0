#pragma once
/// \file
/// Invariants of predicates for any input.

#include <cstdlib>

#include "spark/predicates.h"

namespace spark::fuzz {

/// Visits all elements with the functions that effectors use. Aborts if lists are not properly nested.
inline void checkElement(const Element& e, std::uint32_t end) {
  const Token& t = e.token();
  if (e.index() >= end) std::abort();
  (void)e.number();
  (void)e.integer();
  (void)e.text().size();
  if (!e.isList()) return;
  if (t.size == 0 || t.size > end - e.index()) std::abort();
  (void)e.head();
  (void)e.named("unum");
  for (const Element inner : e) checkElement(inner, e.index() + t.size);
}

inline void checkTree(const Predicates& p) {
  for (const Element e : p) checkElement(e, p.size());
}

}  // namespace spark::fuzz
