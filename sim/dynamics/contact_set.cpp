#include "sim/dynamics/contact_set.hpp"

#include "core/parallel.hpp"

namespace scree {

bool ImpulseMemory::recall(const ManifoldHeader& manifold, const ContactPoint* points, Vec3* impulses) const {
  for (int k = 0; k < manifold.count; ++k) impulses[k].setZero();
  bool loaded = false;
  for (const Entry& entry : index().of(manifold.i, manifold.j, manifold.part)) {
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

namespace {

struct PrepareContact {
  Manifolds manifolds;
  ContactLaws laws;
  const ImpulseMemory* memory;
  double scale;
  ResponseParameters parameters;
  View<Contact> contacts;
  View<ContactRow> rows;

  void operator()(std::int64_t c) const {
    const ManifoldHeader& manifold = manifolds.headers[c];
    const PairLaw& law = laws.between(manifold.i, manifold.j);
    const double friction = parameters.friction ? law.friction : 0.0;
    Vec3 remembered[Manifold::max_points];
    const bool loaded = memory->recall(manifold, manifolds.points_of(manifold), remembered);
    const int free_ends =
        static_cast<int>(laws.is_free(manifold.i)) + static_cast<int>(laws.is_free(manifold.j));
    contacts[c] = {.i = manifold.i,
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
                   .lead = 0,
                   .size = laws.smaller_size(manifold.i, manifold.j)};
    for (int k = 0; k < manifold.count; ++k) {
      rows[manifold.first_point + k].impulse =
          parameters.warm_start ? project_on_cone(scale * remembered[k], manifold.normal, friction)
                                : Vec3(Vec3::Zero());
    }
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

}  // namespace

void ImpulseMemory::remember(const Manifolds& manifolds, const ContactSet& set, std::int64_t bodies) {
  entries_.resize(manifolds.size());
  points_.resize(manifolds.points.size());
  begin_.resize(bodies + 1);
  parallel::for_each<Host>("contacts.remember", manifolds.size(),
                           StoreEntry{manifolds, set.rows.view(), entries_.view(), points_.view()});
  parallel::for_each<Host>("contacts.remember", manifolds.size() + 1,
                           MarkBegins{manifolds.headers, begin_.view()});
}

void prepare_contacts(const Manifolds& manifolds, const ContactLaws& laws, const ImpulseMemory& memory,
                      double scale, const ResponseParameters& parameters, ContactSet& set) {
  set.contacts.resize(manifolds.size());
  set.rows.resize(manifolds.points.size());
  set.couplings.resize(manifolds.points.size());
  parallel::for_each<Host>(
      "contacts.prepare", manifolds.size(),
      PrepareContact{manifolds, laws, &memory, scale, parameters, set.contacts.view(), set.rows.view()});
}

}  // namespace scree
