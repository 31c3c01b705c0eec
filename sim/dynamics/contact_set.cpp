#include "sim/dynamics/contact_set.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <tuple>

namespace scree {

namespace {

/// What manifolds and remembered impulses are ordered by.
template <class Contact>
auto place_of(const Contact& c) {
  return std::tuple(c.i, c.j, c.part);
}

}  // namespace

bool ImpulseMemory::recall(const Manifold& manifold, Vec3 impulses[Manifold::max_points]) const {
  for (int k = 0; k < manifold.count; ++k) impulses[k].setZero();
  bool loaded = false;
  const auto before = [](const Entry& entry, const Manifold& wanted) {
    return place_of(entry) < place_of(wanted);
  };
  auto entry = std::lower_bound(entries_.begin(), entries_.end(), manifold, before);
  for (; entry != entries_.end() && place_of(*entry) == place_of(manifold); ++entry) {
    for (int old = 0; old < entry->count; ++old) {
      loaded = loaded || !entry->impulse[old].isZero(0);
      for (int k = 0; k < manifold.count; ++k) {
        if (entry->feature[old] == manifold.points[k].feature) impulses[k] = entry->impulse[old];
      }
    }
  }
  return loaded;
}

namespace {

struct PrepareContact {
  ConstView<Manifold> manifolds;
  const std::int32_t* order;
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
    contacts[c] = {.i = manifold.i,
                   .j = manifold.j,
                   .manifold = order[c],
                   .count = manifold.count,
                   .normal = manifold.normal,
                   .friction = friction,
                   .restitution = parameters.restitution ? law.restitution : 0.0,
                   .loaded = loaded,
                   .falling = false,
                   .free_ends = static_cast<int>(laws.mobility[manifold.i] == Mobility::free) +
                                static_cast<int>(laws.mobility[manifold.j] == Mobility::free),
                   .impulse = Vec3::Zero()};
    for (int k = 0; k < manifold.count; ++k) {
      rows[c * Manifold::max_points + k].impulse =
          parameters.warm_start ? project_on_cone(scale * remembered[k], manifold.normal, friction)
                                : Vec3(Vec3::Zero());
    }
  }
};

}  // namespace

void prepare_contacts(ConstView<Manifold> manifolds, const ContactLaws& laws, const ImpulseMemory& memory,
                      double scale, const ResponseParameters& parameters, ContactSet& set) {
  set.contacts.resize(manifolds.size());
  set.rows.resize(manifolds.size() * Manifold::max_points);
  parallel::for_each<Host>("contacts.prepare", manifolds.size(),
                           PrepareContact{manifolds, set.coloring.order.data(), laws, &memory, scale,
                                          parameters, set.contacts.view(), set.rows.view()});
}

void remember_impulses(ConstView<Manifold> manifolds, const ContactSet& set, ImpulseMemory& memory) {
  std::vector<ImpulseMemory::Entry>& entries = memory.entries();
  entries.resize(static_cast<std::size_t>(manifolds.size()));
  for (std::int64_t c = 0; c < set.contacts.size(); ++c) {
    const Contact& contact = set.contacts.view()[c];
    ImpulseMemory::Entry& entry = entries[static_cast<std::size_t>(contact.manifold)];
    entry.i = contact.i;
    entry.j = contact.j;
    entry.part = manifolds[contact.manifold].part;
    entry.count = contact.count;
    for (int k = 0; k < contact.count; ++k) {
      entry.feature[k] = manifolds[contact.manifold].points[k].feature;
      entry.impulse[k] = set.rows.view()[c * Manifold::max_points + k].impulse;
    }
  }
}

}  // namespace scree
