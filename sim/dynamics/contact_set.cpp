#include "sim/dynamics/contact_set.hpp"

#include "core/parallel_loops.hpp"
#include "core/tolerances.hpp"

namespace scree {

bool ImpulseMemory::recall(const ManifoldHeader& manifold, const ContactPoint* points, Vec3* impulses) const {
  for (int k = 0; k < manifold.count; ++k) impulses[k].setZero();
  bool loaded = false;
  const ConstView<Entry> entries = index().of(manifold.i, manifold.j, manifold.part);
  if (entries.size() == 0) {
    const std::int32_t candidate = balls.index().candidate_of(manifold.i, manifold.j);
    if (candidate == lanes::none) return false;
    impulses[0] = balls.impulse(candidate);
    return balls.index().is_loaded(candidate);
  }
  for (const Entry& entry : entries) {
    loaded = loaded || entry.loaded;
    for (int old = 0; old < entry.count; ++old) {
      const Point& point = points_.view()[entry.first_point + old];
      for (int k = 0; k < manifold.count; ++k) {
        if (point.feature == points[k].feature) impulses[k] = point.impulse;
      }
    }
  }
  return loaded;
}

Vec3 ImpulseMemory::recall_couple(const ManifoldHeader& manifold) const {
  const ConstView<Entry> entries = index().of(manifold.i, manifold.j, manifold.part);
  if (entries.size() > 0) return couples_.view()[entries.data() - entries_.data()];
  const std::int32_t candidate = balls.index().candidate_of(manifold.i, manifold.j);
  return candidate == lanes::none ? Vec3(Vec3::Zero()) : balls.couple(candidate);
}

namespace {

struct PrepareContact {
  Manifolds manifolds;
  ContactLaws laws;
  const ImpulseMemory* memory;
  double scale;
  ResponseParameters parameters;
  View<Contact> contacts;
  View<ContactRow> rows;
  View<Vec3> couples;

  void operator()(std::int64_t c) const {
    const ManifoldHeader& manifold = manifolds.headers[c];
    const PairLaw& law = laws.between(manifold.i, manifold.j);
    const double friction = parameters.friction ? law.friction : 0.0;
    Vec3 remembered[Manifold::max_points];
    const bool loaded = memory->recall(manifold, manifolds.points_of(manifold), remembered);
    const int free_ends =
        static_cast<int>(laws.is_free(manifold.i)) + static_cast<int>(laws.is_free(manifold.j));
    contacts[c] = {
        .i = manifold.i,
        .j = manifold.j,
        .first_row = manifold.first_point,
        .count = manifold.count,
        .loaded = loaded,
        .flying = false,
        .balls = laws.acts_as_ball(manifold.i) && laws.acts_as_ball(manifold.j),
        .aligned = false,
        .free_ends = static_cast<std::int8_t>(free_ends),
        .normal = manifold.normal,
        .friction = friction,
        .rolling_reach = parameters.rolling_friction ? laws.rolling_reach(manifold.i, manifold.j) : 0.0,
        .lead = 0,
        .size = laws.smaller_size(manifold.i, manifold.j)};
    for (int k = 0; k < manifold.count; ++k) {
      rows[manifold.first_point + k].impulse =
          parameters.warm_start ? project_on_cone(scale * remembered[k], manifold.normal, friction)
                                : Vec3(Vec3::Zero());
    }
    if (couples.size() > 0)
      couples[c] = parameters.warm_start ? Vec3(scale * memory->recall_couple(manifold)) : Vec3(Vec3::Zero());
  }
};

struct StoreEntry {
  Manifolds manifolds;
  ConstView<ContactRow> rows;
  View<ImpulseMemory::Entry> entries;
  View<ImpulseMemory::Point> points;
  SCREE_HD void operator()(std::int64_t m) const {
    const ManifoldHeader& manifold = manifolds.headers[m];
    bool loaded = false;
    for (int k = 0; k < manifold.count; ++k) {
      const std::int64_t p = manifold.first_point + k;
      points[p] = {rows[p].impulse, manifolds.points[p].feature};
      loaded = loaded || !rows[p].impulse.isZero(0);
    }
    entries[m] = {manifold.j, manifold.part, manifold.count, loaded, manifold.first_point};
  }
};

/// The manifolds are ordered by i: each one marks where the bodies after the last i up to its own begin.
struct MarkBegins {
  ConstView<ManifoldHeader> manifolds;
  View<std::int64_t> begin;
  SCREE_HD void operator()(std::int64_t m) const {
    const std::int64_t last = m > 0 ? manifolds[m - 1].i : -1;
    const std::int64_t own = m < manifolds.size() ? manifolds[m].i : begin.size() - 1;
    for (std::int64_t i = last + 1; i <= own; ++i) begin[i] = m;
  }
};

/// Those of BallPairs, in the order of the candidates, behind the others.
struct ListPairs {
  lanes::Batches* batches;
  ConstView<SolverBody> bodies;
  std::int64_t first_contact, first_row;
  View<Contact> contacts;
  View<ContactRow> rows;
  View<Vec3> couples;
  void operator()(std::int64_t place) const {
    const std::int32_t lane = batches->lane_of.view()[place];
    const std::int32_t b = lane / lanes::width;
    const int l = lane % lanes::width;
    const lanes::BallBatch& batch = batches->balls.view()[b];
    const lanes::BallParting& parting = batches->partings.view()[b];
    lanes::Members& members = batches->ball_members.view()[b];
    const std::int64_t c = first_contact + place;
    const std::int64_t r = first_row + place;
    members.contact[l] = static_cast<std::int32_t>(c);
    members.row[l] = r;
    const Vec3 normal(batch.normal.x.at[l], batch.normal.y.at[l], batch.normal.z.at[l]);
    const lanes::LaneVec& p = batch.impulse.impulse;
    ContactRow& row = rows[r];
    row = row_at(batch.arm_i.at[l] * normal, batch.arm_j.at[l] * normal, parting.gap.at[l]);
    row.bend = parting.bend.at[l];
    row.target = batch.target.at[l];
    row.impulse = Vec3(p.x.at[l], p.y.at[l], p.z.at[l]);
    row.normal_mass = batch.normal_mass.at[l];
    row.tangent_mass = batch.tangent_mass.at[l];
    contacts[c] = {.i = batch.ends.i[l],
                   .j = batch.ends.j[l],
                   .first_row = r,
                   .count = 1,
                   .loaded = parting.loaded[l] != 0,
                   .flying = parting.flying[l] != 0,
                   .balls = true,
                   .aligned = true,
                   .free_ends = static_cast<std::int8_t>(bodies[batch.ends.i[l]].is_free() +
                                                         bodies[batch.ends.j[l]].is_free()),
                   .normal = normal,
                   .friction = batch.friction.at[l],
                   .rolling_reach = 0,
                   .lead = 0,
                   .size = parting.cap.at[l] / tolerance::correction_cap};
    if (couples.size() == 0) return;
    const lanes::Rolling& rolling = batches->ball_rolling.view()[b];
    const lanes::LaneVec& couple = rolling.couple.impulse;
    contacts[c].rolling_reach = rolling.reach.at[l];
    couples[c] = {couple.x.at[l], couple.y.at[l], couple.z.at[l]};
  }
};

/// Makes an array larger and keeps what is in it.
template <class T>
void extend(Array<T, Host>& values, std::int64_t n) {
  Array<T, Host> longer(n);
  copy_bytes<Host, Host>(longer.data(), values.data(), static_cast<std::size_t>(values.size()) * sizeof(T));
  values.swap(longer);
}

}  // namespace

void ContactSet::list_all(ConstView<SolverBody> bodies) {
  if (all_are_listed) return;
  lanes::store_masses(batches, rows.view());
  all_are_listed = true;
  if (pairs == 0) return;
  const std::int64_t first_contact = contacts.size();
  const std::int64_t first_row = rows.size();
  extend(contacts, first_contact + pairs);
  extend(rows, first_row + pairs);
  if (rolls) extend(couples, first_contact + pairs);
  parallel::for_each<Host>(
      "contacts.list", pairs,
      ListPairs{&batches, bodies, first_contact, first_row, contacts.view(), rows.view(), couples.view()});
}

void ImpulseMemory::remember(const Manifolds& manifolds, const ContactSet& set, std::int64_t bodies) {
  entries_.resize(manifolds.size());
  points_.resize(manifolds.points.size());
  couples_.resize(set.rolls ? manifolds.size() : 0);
  copy_bytes<Host, Host>(couples_.data(), set.couples.data(),
                         static_cast<std::size_t>(couples_.size()) * sizeof(Vec3));
  begin_.resize(bodies + 1);
  parallel::for_each<Host>("contacts.remember", manifolds.size(),
                           StoreEntry{manifolds, set.rows.view(), entries_.view(), points_.view()});
  parallel::for_each<Host>("contacts.remember", manifolds.size() + 1,
                           MarkBegins{manifolds.headers, begin_.view()});
  if (balls.size() == 0) return;
  balls.remember(set.batches);
  // Pairs of which one was struck late are among the manifolds.
  for (const ManifoldHeader& m : manifolds.headers) {
    const std::int32_t candidate = balls.index().candidate_of(m.i, m.j);
    if (candidate == lanes::none) continue;
    balls.remember(candidate, set.rows.view()[m.first_point].impulse);
    if (set.rolls) balls.remember_couple(candidate, set.couples.view()[&m - manifolds.headers.data()]);
  }
}

void prepare_contacts(const Manifolds& manifolds, const ContactLaws& laws, const ImpulseMemory& memory,
                      double scale, const ResponseParameters& parameters, ContactSet& set) {
  set.pairs = static_cast<std::int64_t>(memory.balls.touching().size());
  set.all_are_listed = false;
  set.batches.clear();
  set.contacts.resize(manifolds.size());
  set.rows.resize(manifolds.points.size());
  set.rolls = parameters.rolling_friction;
  set.couples.resize(set.rolls ? manifolds.size() : 0);
  parallel::for_each<Host>("contacts.prepare", manifolds.size(),
                           PrepareContact{manifolds, laws, &memory, scale, parameters, set.contacts.view(),
                                          set.rows.view(), set.couples.view()});
}

}  // namespace scree
