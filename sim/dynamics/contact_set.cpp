#include "sim/dynamics/contact_set.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <utility>

namespace scree {

ConstView<ImpulseMemory::Entry> ImpulseMemory::entries_of(std::int32_t i, std::int32_t j,
                                                          std::int32_t part) const {
  if (begin_.empty()) return {};
  const auto place = [](const Entry& entry) { return std::pair(entry.j, entry.part); };
  // A floor may have as many entries as there are bodies.
  const auto range =
      std::ranges::equal_range(entries_.data() + begin_.view()[i], entries_.data() + begin_.view()[i + 1],
                               std::pair(j, part), {}, place);
  return {range.data(), static_cast<std::int64_t>(range.size())};
}

bool ImpulseMemory::is_loaded(std::int32_t i, std::int32_t j, std::int32_t part) const {
  const ConstView<Entry> entries = entries_of(i, j, part);
  return std::any_of(entries.begin(), entries.end(), [](const Entry& entry) { return entry.is_loaded(); });
}

bool ImpulseMemory::recall(const Manifold& manifold, Vec3 impulses[Manifold::max_points]) const {
  for (int k = 0; k < manifold.count; ++k) impulses[k].setZero();
  bool loaded = false;
  for (const Entry& entry : entries_of(manifold.i, manifold.j, manifold.part)) {
    loaded = loaded || entry.is_loaded();
    for (int old = 0; old < entry.count; ++old) {
      for (int k = 0; k < manifold.count; ++k) {
        if (entry.feature[old] == manifold.points[k].feature) impulses[k] = entry.impulse[old];
      }
    }
  }
  return loaded;
}

namespace {

struct CountPoints {
  ConstView<Manifold> manifolds;
  const std::int32_t* order;
  View<std::int32_t> counts;
  SCREE_HD void operator()(std::int64_t c) const { counts[c] = manifolds[order[c]].count; }
};

struct PrepareContact {
  ConstView<Manifold> manifolds;
  const std::int32_t* order;
  ConstView<std::int64_t> first_row;
  ContactLaws laws;
  const ImpulseMemory* memory;
  double scale;
  ResponseParameters parameters;
  View<Contact> contacts;
  View<ContactRow> rows;

  void operator()(std::int64_t c) const {
    const Manifold& manifold = manifolds[order[c]];
    const PairLaw& law = laws.between(manifold.i, manifold.j);
    const double friction = parameters.friction ? law.friction : 0.0;
    Vec3 remembered[Manifold::max_points];
    const bool loaded = memory->recall(manifold, remembered);
    contacts[c] = {
        .i = manifold.i,
        .j = manifold.j,
        .manifold = order[c],
        .count = manifold.count,
        .first_row = first_row[c],
        .normal = manifold.normal,
        .friction = friction,
        .restitution = parameters.restitution ? law.restitution : 0.0,
        .loaded = loaded,
        .flying = false,
        .balls = laws.acts_as_ball(manifold.i) && laws.acts_as_ball(manifold.j),
        .aligned = false,
        .free_ends = static_cast<int>(laws.is_free(manifold.i)) + static_cast<int>(laws.is_free(manifold.j)),
        .lead = 0,
        .impulse = Vec3::Zero()};
    for (int k = 0; k < manifold.count; ++k) {
      rows[first_row[c] + k].impulse = parameters.warm_start
                                           ? project_on_cone(scale * remembered[k], manifold.normal, friction)
                                           : Vec3(Vec3::Zero());
    }
  }
};

struct StoreEntry {
  ConstView<Manifold> manifolds;
  ConstView<Contact> contacts;
  ConstView<ContactRow> rows;
  View<ImpulseMemory::Entry> entries;
  SCREE_HD void operator()(std::int64_t c) const {
    const Contact& contact = contacts[c];
    ImpulseMemory::Entry& entry = entries[contact.manifold];
    entry.j = contact.j;
    entry.part = manifolds[contact.manifold].part;
    entry.count = contact.count;
    for (int k = 0; k < contact.count; ++k) {
      entry.feature[k] = manifolds[contact.manifold].points[k].feature;
      entry.impulse[k] = rows[contact.first_row + k].impulse;
    }
  }
};

/// The manifolds are ordered by i: each one marks where the bodies after the last i up to its own begin.
struct MarkBegins {
  ConstView<Manifold> manifolds;
  View<std::int64_t> begin;
  SCREE_HD void operator()(std::int64_t m) const {
    const std::int64_t last = m > 0 ? manifolds[m - 1].i : -1;
    const std::int64_t own = m < manifolds.size() ? manifolds[m].i : begin.size() - 1;
    for (std::int64_t i = last + 1; i <= own; ++i) begin[i] = m;
  }
};

}  // namespace

void ImpulseMemory::remember(ConstView<Manifold> manifolds, const ContactSet& set, std::int64_t bodies) {
  entries_.resize(manifolds.size());
  begin_.resize(bodies + 1);
  parallel::for_each<Host>("contacts.remember", manifolds.size(),
                           StoreEntry{manifolds, set.contacts.view(), set.rows.view(), entries_.view()});
  parallel::for_each<Host>("contacts.remember", manifolds.size() + 1, MarkBegins{manifolds, begin_.view()});
}

void prepare_contacts(ConstView<Manifold> manifolds, const ContactLaws& laws, const ImpulseMemory& memory,
                      double scale, const ResponseParameters& parameters, ContactSet& set) {
  const std::int64_t n = manifolds.size();
  const std::int32_t* order = set.coloring.order.data();
  set.contacts.resize(n);
  set.counts.resize(n);
  parallel::for_each<Host>("contacts.count", n, CountPoints{manifolds, order, set.counts.view()});
  const std::int64_t rows = parallel::exclusive_scan<Host>("contacts.first_row", set.counts, set.first_row);
  set.rows.resize(rows);
  set.couplings.resize(rows);
  parallel::for_each<Host>("contacts.prepare", n,
                           PrepareContact{manifolds, order, std::as_const(set.first_row).view(), laws,
                                          &memory, scale, parameters, set.contacts.view(), set.rows.view()});
}

}  // namespace scree
