#include <algorithm>

#include "api/contact_points.h"
#include "mujoco_world.h"

// The contacts of a world in MuJoCo: which pairs may touch, what is reported, and what is solved.

namespace spark::mujoco {

using engine::Contact;
using engine::Model;
using engine::State;

namespace {
bool contains(const std::vector<std::uint64_t>& sorted, std::uint64_t pair) {
  return std::binary_search(sorted.begin(), sorted.end(), pair);
}
}  // namespace

bool MujocoWorld::mayTouch(void* world, int geom1, int geom2) {
  const MujocoWorld& w = *static_cast<MujocoWorld*>(world);
  const Index i = w.geomOf_[geom1], k = w.geomOf_[geom2];
  if (i == kNone || k == kNone) return false;
  if (!w.chosen_.empty() && contains(w.chosen_, pairOf(i, k))) return true;
  const engine::Geom &a = w.model_->geoms[i], &b = w.model_->geoms[k];
  if (a.body != kNone && a.body == b.body) return false;
  if (a.space == b.space && !w.model_->spaces[a.space].inner) return false;
  if (a.body != kNone && b.body != kNone && contains(w.joined_, pairOf(a.body, b.body))) return false;
  return !w.filter_ || w.filter_(a.owner, b.owner);
}

void MujocoWorld::prepare(const Model& model) {
  model_ = &model;
  const Session session(message_, m_.get(), mayTouch, this, nullptr, &pieceContacts_);
  mj_step1(m_.get(), d_.get());
  prepared_ = true;
  findSpare();
}

void MujocoWorld::findSpare() {
  pairs_.clear();
  for (int i = 0; i < d_->ncon; ++i)
    pairs_.emplace_back(pairOf(geomOf_[d_->contact[i].geom1], geomOf_[d_->contact[i].geom2]), i);
  std::sort(pairs_.begin(), pairs_.end());
  spare_.clear();
  for (std::size_t first = 0, end; first < pairs_.size(); first = end) {
    end = first + 1;
    while (end < pairs_.size() && pairs_[end].first == pairs_[first].first) ++end;
    if (end - first > static_cast<std::size_t>(perPair_)) thinOut({pairs_.data() + first, end - first});
  }
}

void MujocoWorld::thinOut(std::span<const std::pair<std::uint64_t, int>> pair) {
  const auto contact = [&](std::size_t i) -> const mjContact& { return d_->contact[pair[i].second]; };
  engine::choosePoints(
      pair.size(), static_cast<std::size_t>(perPair_), [&](std::size_t i) { return toVec(contact(i).pos); },
      [&](std::size_t i) { return -contact(i).dist; }, apart_);
  spare_.resize(pairs_.size(), Use::reported);
  const bool all = options_.allContacts != 0 && !isPiece(contact(0).geom1) && !isPiece(contact(0).geom2);
  const Use use = all ? Use::solved : Use::dropped;
  for (std::size_t i = 0; i < pair.size(); ++i)
    if (apart_[i] >= 0) spare_[static_cast<std::size_t>(pair[i].second)] = use;
}

bool MujocoWorld::isPiece(int geom) const {
  const Index i = geomOf_[geom];
  return i != kNone && model_->geoms[i].shape.shape == engine::Shape::mesh && model_->geoms[i].body == kNone;
}

void MujocoWorld::prepareAgain(const Model& model) {
  listed_.clear();
  prepare(model);
}

void MujocoWorld::detect(const Model& model, const State& state, engine::PairFilter filter, int perPair,
                         engine::Contacts& out) {
  filter_ = filter;
  perPair_ = perPair;
  take(model, state);
  prepare(model);
  listed_.clear();
  for (int i = 0; i < d_->ncon; ++i) {
    if (useOf(i) != Use::reported) continue;
    const mjContact& from = d_->contact[i];
    Index a = geomOf_[from.geom1], b = geomOf_[from.geom2];
    const bool swapped = !engine::comesFirst(model.geoms[a], model.geoms[b]);
    if (swapped) std::swap(a, b);
    Contact& c = out.emplace_back();
    c.geomA = a, c.geomB = b;
    c.bodyA = model.geoms[a].body, c.bodyB = model.geoms[b].body;
    c.ownerA = model.geoms[a].owner, c.ownerB = model.geoms[b].owner;
    c.position = toVec(from.pos);
    // MuJoCo's normal points from the first geom to the second.
    c.normal = (swapped ? 1 : -1) * toVec(from.frame);
    c.depth = std::max(0.0, -from.dist);
    listed_.push_back(i);
  }
}

void MujocoWorld::findUnsolved(std::span<const Contact> contacts) {
  ghosts_.clear();
  for (const Contact& c : contacts)
    if (!c.solve) ghosts_.push_back(pairOf(c.geomA, c.geomB));
  std::sort(ghosts_.begin(), ghosts_.end());
}

void MujocoWorld::releaseUnsolved() {
  for (int i = 0; i < d_->ncon; ++i) {
    const mjContact& c = d_->contact[i];
    if (c.efc_address < 0) continue;
    if (useOf(i) != Use::dropped && !contains(ghosts_, pairOf(geomOf_[c.geom1], geomOf_[c.geom2]))) continue;
    const int rows = c.dim == 1 ? 1 : m_->opt.cone == mjCONE_PYRAMIDAL ? 2 * (c.dim - 1) : c.dim;
    for (int row = c.efc_address; row < c.efc_address + rows; ++row) d_->efc_D[row] = 1e-15, d_->efc_R[row] = 1e15;
  }
}

Vec3 MujocoWorld::forceOf(int contact, Index on) const {
  mjtNum force[6];  // in the contact's frame, on the second geom
  mj_contactForce(m_.get(), d_.get(), contact, force);
  const mjContact& from = d_->contact[contact];
  Vec3 onSecond = Vec3::Zero();
  for (int k = 0; k < 3; ++k) onSecond += force[k] * toVec(from.frame + 3 * k);
  return geomOf_[from.geom2] == on ? onSecond : Vec3(-onSecond);
}

void MujocoWorld::readContactForces(std::span<Contact> contacts) const {
  if (contacts.size() != listed_.size()) return;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (Contact& c = contacts[i]; c.feedback && c.solve) c.forceOnA = forceOf(listed_[i], c.geomA);
  if (std::none_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.feedback; })) return;
  // The force of one that is not reported is added to the nearest one of its pair.
  for (int i = 0; i < d_->ncon && !spare_.empty(); ++i) {
    if (useOf(i) != Use::solved) continue;
    const std::uint64_t pair = pairOf(geomOf_[d_->contact[i].geom1], geomOf_[d_->contact[i].geom2]);
    Contact* nearest = nullptr;
    double least = HUGE_VAL;
    for (Contact& c : contacts) {
      if (pairOf(c.geomA, c.geomB) != pair) continue;
      const double distance = (c.position - toVec(d_->contact[i].pos)).squaredNorm();
      if (distance < least) nearest = &c, least = distance;
    }
    if (nearest && nearest->feedback && nearest->solve) nearest->forceOnA += forceOf(i, nearest->geomA);
  }
}

}  // namespace spark::mujoco
