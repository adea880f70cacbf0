#include "kept_hulls.h"

#include <list>
#include <mutex>

#include "hull.h"
#include "spark/random.h"

namespace spark::meshes {

namespace {

using Shared = std::shared_ptr<const engine::Mesh>;

constexpr std::size_t kMostNumbers = 4'000'000;

template <class T>
std::string_view bytesOf(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

std::size_t numbersOf(const engine::Mesh& m) { return m.vertices.size() + m.triangles.size(); }

/// Hulls by their surfaces; the one that was used last comes first.
class KeptHulls {
 public:
  Shared find(const engine::Mesh& surface, std::uint64_t hash) {
    const std::lock_guard lock(mutex_);
    for (auto kept = kept_.begin(); kept != kept_.end(); ++kept)
      if (kept->hash == hash && *kept->surface == surface) {
        kept_.splice(kept_.begin(), kept_, kept);
        return kept->hull;
      }
    return nullptr;
  }
  void keep(const Shared& surface, std::uint64_t hash, const Shared& hull) {
    const std::lock_guard lock(mutex_);
    kept_.push_front({hash, surface, hull});
    numbers_ += kept_.front().numbers();
    for (; numbers_ > kMostNumbers; kept_.pop_back()) numbers_ -= kept_.back().numbers();
  }

 private:
  struct Kept {
    std::uint64_t hash;
    Shared surface, hull;
    std::size_t numbers() const { return numbersOf(*surface) + numbersOf(*hull); }
  };
  std::mutex mutex_;
  std::list<Kept> kept_;
  std::size_t numbers_ = 0;  ///< of all
};

}  // namespace

Shared keptHullOf(const Shared& surface) {
  static KeptHulls kept;
  const std::uint64_t hash = hashBytes(bytesOf(surface->triangles), hashBytes(bytesOf(surface->vertices)));
  if (Shared known = kept.find(*surface, hash)) return known;
  auto hull = std::make_shared<const engine::Mesh>(hullOf(surface->vertices));
  kept.keep(surface, hash, hull);
  return hull;
}

}  // namespace spark::meshes
