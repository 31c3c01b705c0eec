// What Host does for contacts of balls in double precision by the kernels: it finds those of a tile of slots,
// and books those of some blocks.
#pragma once

#include "core/space_tiles.hpp"
#include "sim/resident/books.hpp"
#include "sim/resident/find_balls.hpp"
#include "sim/resident/visit_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace scree::resident {

/// Of each body, and before the first of nobody.
struct SetReach {
  FindStage<double> stage;
  Reach* reach;  ///< of the first body
  void operator()(std::int64_t k) const {
    const auto body = static_cast<std::int32_t>(k - 1);
    if (body < 0) {
      reach[body] = {0, 0, 0, -HUGE_VAL};
      return;
    }
    const MidBody<double>& mid = stage.mid[body];
    const bool apart = mid.shape != Shape::sphere || (stage.any_is_late && stage.struck.stage.is_late(body));
    const Vec3& x = mid.position;
    reach[body] = {x.x(), x.y(), x.z(), apart ? HUGE_VAL : mid.size + mid.margin};
  }
};

/// Contacts of two balls are made by the kernels, others one by one.
struct FindBallTile {
  FindBalls<double> one_by_one;
  const Reach* reach;
  std::int32_t* counts;

  void operator()(std::int64_t t) const {
    const FindStage<double>& stage = one_by_one.stage;
    const std::int64_t first = t * parallel::tile;
    const Slot* const slots = stage.places.data() + first;
    const Period* const period = stage.bodies.period.exists ? &stage.bodies.period : nullptr;
    std::array<std::uint8_t, parallel::tile> slot_of;
    std::array<Rare, parallel::tile> rare;
    int count = 0, rare_count = 0;
    for (int s = 0; s < parallel::tile && slots[s].i != Slot::empty; s += look) {
      const std::uint64_t near = visit_kernels().near(reach, slots + s, period);
      for (int k = s; k < s + look && slots[k].i != Slot::empty; ++k) {
        if ((near >> (k - s) & 1) == 0) {
          one_by_one.memory[first + k] = {};
          continue;
        }
        if (!is_common(slots[k])) {
          Rare& found = rare[static_cast<std::size_t>(rare_count)];
          if (!one_by_one.find(first + k, found.record)) continue;
          found.contact = count;
          ++rare_count;
        }
        slot_of[static_cast<std::size_t>(count++)] = static_cast<std::uint8_t>(k);
      }
    }
    const PrepareBalls prepare{stage.mid.data(), one_by_one.contacts, period, stage.step, stage.noise};
    for (int c = 0; c < count; c += lanes::width)
      prepare_block(prepare, slots, slot_of.data() + c, first + c, std::min(count - c, lanes::width));
    for (int r = 0; r < rare_count; ++r) {
      const Rare& found = rare[static_cast<std::size_t>(r)];
      one_by_one.store(first + found.contact, first + slot_of[static_cast<std::size_t>(found.contact)],
                       found.record);
    }
    counts[t] = count;
  }

 private:
  struct Rare {
    int contact;
    FindBalls<double>::Record record;
  };

  bool is_common(const Slot& slot) const {
    return reach[slot.i].extent < HUGE_VAL && reach[slot.j].extent < HUGE_VAL && slot.end_i == slot.i &&
           slot.end_j == slot.j;
  }

  /// Others among them are made anew after that.
  void prepare_block(const PrepareBalls& prepare, const Slot* slots, const std::uint8_t* slot_of,
                     std::int64_t place, int count) const {
    const FindStage<double>& stage = one_by_one.stage;
    const BallContacts<double>& contacts = one_by_one.contacts;
    const std::int64_t first = place - place % parallel::tile;
    const double scale = stage.parameters.warm_start ? stage.scale : 0.0;
    BallBlock block;
    std::uint32_t loaded = 0, common = 0;
    for (int l = 0; l < lanes::width; ++l) {
      const int s = slot_of[std::min(l, count - 1)];
      const Slot& slot = slots[s];
      const MidBody<double>& i = stage.mid[slot.i];
      const MidBody<double>& j = stage.mid[slot.j];
      const BallMemory<double>& memory = one_by_one.memory[first + s];
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
      common |= (is_common(slot) ? 1u : 0u) << l;
    }
    const std::uint32_t closing = visit_kernels().prepare_balls(prepare, block, place);
    for (int l = 0; l < count; ++l) {
      if ((common >> l & 1) == 0) continue;
      const Slot& slot = slots[slot_of[l]];
      contacts.ends[place + l] = {slot.end_i, slot.end_j};
      contacts.slot[place + l] = slot_of[l];
      contacts.flags[place + l] = 0;
      if ((closing >> l & 1) != 0 && (loaded >> l & 1) == 0) one_by_one.passing.add(place + l);
    }
  }
};

/// Of a run of blocks: BookBalls.
struct BookBallBlocks {
  static constexpr std::int64_t together = 32;

  BookBlocks book;
  ConstView<std::int32_t> blocks;
  ConstView<std::int32_t> found;  ///< contacts of each tile
  BookStage<double> stage;
  View<BallMemory<double>> memory;

  Books operator()(std::int64_t run) const {
    const std::int64_t first = run * together;
    const Blocks of{blocks.data() + first, std::min(together, blocks.size() - first)};
    const BlockBooks sums = visit_kernels().book_balls(book, of);
    for (std::int64_t b = 0; b < of.count; ++b) remember(of.places[b]);
    return {.restitution = sums.restitution,
            .friction = sums.friction,
            .work = sums.work,
            .gaps = sums.gaps,
            .loaded = sums.loaded,
            .ends = sums.ends,
            .gaining = sums.gaining,
            .deepest = sums.deepest,
            .gap_power = sums.gap_power,
            .kick_power = sums.kick_power};
  }

 private:
  void remember(std::int64_t c) const {
    const BallContacts<double>& contacts = book.contacts;
    const std::int64_t first = c - c % parallel::tile;
    const std::int64_t end = std::min(c + lanes::width, first + found[c / parallel::tile]);
    for (; c < end; ++c) {
      const std::int64_t place = first + contacts.slot[c];
      memory[place] = {contacts.fields.vector(BallContacts<double>::impulse, c)};
      if (memory[place].is_loaded()) stage.mark_loaded(stage.places[place], stage.places[place].surface);
    }
  }
};

}  // namespace scree::resident
