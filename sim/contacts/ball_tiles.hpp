// Work on contacts of balls by the kernels, on Host in double precision: finds the contacts of a tile of
// slots, makes the contacts of a block, and adds up the totals of some blocks.
#pragma once

#include "core/space_tiles.hpp"
#include "sim/contacts/contact_accounts.hpp"
#include "sim/contacts/find_balls.hpp"
#include "sim/contacts/visit_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace scree::solver {

/// Sets the reach of each body. The element before that of body 0 belongs to empty slots, whose bodies are
/// Slot::empty; it is near nothing.
struct SetReach {
  FindStage<double> stage;
  Reach* reach;  ///< element of body 0
  void operator()(std::int64_t k) const {
    const auto body = static_cast<std::int32_t>(k - 1);
    if (body < 0) {
      reach[body] = {0, 0, 0, -HUGE_VAL};
      return;
    }
    const MidBody<double>& mid = stage.mid[body];
    const bool apart =
        mid.shape != Shape::sphere || (stage.any_late_impact && stage.struck.stage.has_late_impact(body));
    const Vec3& x = mid.position;
    reach[body] = {x.x(), x.y(), x.z(), apart ? HUGE_VAL : mid.size + mid.margin};
  }
};

/// Whether a slot is one of two balls with a finite reach that are whole bodies. The kernels find and make
/// the contacts of such slots; others are found and made one by one.
inline bool is_common(const Reach* reach, const Slot& slot) {
  return reach[slot.i].extent < HUGE_VAL && reach[slot.j].extent < HUGE_VAL && slot.end_i == slot.i &&
         slot.end_j == slot.j;
}

/// Finds the slots of a tile that have a contact.
struct FindBallTile {
  FindBalls<double> one_by_one;
  const Reach* reach;
  std::int32_t* found;
  std::int32_t* counts;

  void operator()(std::int64_t t) const {
    const FindStage<double>& stage = one_by_one.stage;
    const std::int64_t first = t * parallel::tile;
    const Slot* const slots = stage.places.data() + first;
    const Period* const period = stage.bodies.period.exists ? &stage.bodies.period : nullptr;
    std::int32_t count = 0;
    for (int s = 0; s < parallel::tile && slots[s].i != Slot::empty; s += look) {
      const std::uint64_t near = contact_kernels().near(reach, slots + s, period);
      for (int k = s; k < s + look && slots[k].i != Slot::empty; ++k) {
        FindBalls<double>::Record record;
        if ((near >> (k - s) & 1) == 0) {
          one_by_one.memory[first + k] = {};
        } else if (is_common(reach, slots[k]) || one_by_one.find(first + k, record)) {
          found[first + count++] = static_cast<std::int32_t>(first + k);
        }
      }
    }
    counts[t] = count;
  }
};

/// Makes the contacts of a block.
struct MakeBallBlock {
  FindBalls<double> one_by_one;
  const Reach* reach;

  void operator()(std::int64_t b) const {
    const FindStage<double>& stage = one_by_one.stage;
    const BallContacts<double>& contacts = one_by_one.contacts;
    const std::int64_t first = b * simd::width;
    const double scale = stage.parameters.warm_start ? stage.scale : 0.0;
    BallBlock block;
    std::uint32_t loaded = 0, common = 0;
    for (int l = 0; l < simd::width; ++l) {
      // The first place of a block always holds a contact; empty places of the block repeat its slot.
      const std::int32_t own = contacts.slot[first + l];
      const std::int32_t place = own == Slot::empty ? contacts.slot[first] : own;
      const Slot& slot = stage.places[place];
      const MidBody<double>& i = stage.mid[slot.i];
      const MidBody<double>& j = stage.mid[slot.j];
      const BallMemory<double>& memory = one_by_one.memory[place];
      block.i[l] = slot.i;
      block.j[l] = slot.j;
      block.friction[l] = stage.parameters.friction
                              ? stage.laws.table[i.material * stage.laws.materials + j.material].friction
                              : 0.0;
      block.kick[l] = i.is_free() && j.is_free() && stage.parameters.acceleration.size() == 0
                          ? V3<double>{}
                          : v3<double>(stage.kick_of(j, slot.j) - stage.kick_of(i, slot.i));
      block.impulse[l] = scale * memory.impulse;
      loaded |= (memory.is_loaded() ? 1u : 0u) << l;
      common |= (is_common(reach, slot) ? 1u : 0u) << l;
    }
    const Period* const period = stage.bodies.period.exists ? &stage.bodies.period : nullptr;
    const PrepareBalls prepare{stage.mid.data(), contacts, period, stage.step, stage.noise};
    const std::uint32_t closing = contact_kernels().prepare_balls(prepare, block, first);
    for (int l = 0; l < simd::width; ++l) {
      const std::int64_t c = first + l;
      if (contacts.slot[c] == Slot::empty) return;
      if ((common >> l & 1) == 0) {
        one_by_one.make(c, contacts.slot[c]);
        continue;
      }
      contacts.ends[c] = {block.i[l], block.j[l]};
      contacts.flags[c] = 0;
      if ((closing >> l & 1) != 0 && (loaded >> l & 1) == 0) one_by_one.approaching.add(c);
    }
  }
};

/// Does the work of AccountBalls for a run of blocks.
struct AccountBallBlocks {
  static constexpr std::int64_t together = 32;

  AccountBlocks account;
  AccountStage<double> stage;
  View<BallMemory<double>> memory;

  std::int64_t runs() const { return (blocks() + together - 1) / together; }
  ContactTotals operator()(std::int64_t run) const {
    const std::int64_t first = run * together;
    const Blocks of{first * simd::width, std::min(together, blocks() - first)};
    const BlockTotals sums = contact_kernels().account_balls(account, of);
    for (std::int64_t b = 0; b < of.count; ++b) remember(of.place(b));
    return {.restitution = sums.restitution,
            .friction = sums.friction,
            .work = sums.work,
            .gaps = sums.gaps,
            .loaded = sums.loaded,
            .ends = sums.ends,
            .gaining = sums.gaining,
            .deepest = sums.deepest,
            .residual_power = sums.residual_power,
            .impulse_power = sums.impulse_power};
  }

 private:
  std::int64_t blocks() const { return account.contacts.slot.size() / simd::width; }
  void remember(std::int64_t first) const {
    const BallContacts<double>& contacts = account.contacts;
    for (std::int64_t c = first; c < first + simd::width && contacts.slot[c] != Slot::empty; ++c) {
      const std::int32_t place = contacts.slot[c];
      memory[place] = {contacts.fields.vector(BallContacts<double>::impulse, c)};
      if (memory[place].is_loaded()) stage.mark_loaded_balls(place);
    }
  }
};

}  // namespace scree::solver
