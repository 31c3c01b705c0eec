#include "sim/dynamics/lanes/batches.hpp"

#include "core/parallel_loops.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/lanes/colored.hpp"

#include <array>

namespace scree::lanes {

namespace {

static_assert(most_points == Manifold::max_points);
int kind_of(const Contact& contact) { return contact.aligned ? 1 : 1 + contact.count; }

constexpr Members nothing = {{none, none, none, none, none, none, none, none}, {}, false};

void put(Lane& lane, int l, double value) { lane.at[l] = value; }
void put(LaneVec& lanes, int l, const Vec3& value) {
  put(lanes.x, l, value.x());
  put(lanes.y, l, value.y());
  put(lanes.z, l, value.z());
}
void put(Lane* lanes, int l, const Mat3& m) {
  const double values[] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  for (int k = 0; k < 6; ++k) put(lanes[k], l, values[k]);
}
Vec3 take(const LaneVec& lanes, int l) { return {lanes.x.at[l], lanes.y.at[l], lanes.z.at[l]}; }

void start_from(LaneImpulse& lanes, int l, const Vec3& impulse) {
  put(lanes.impulse, l, impulse);
  put(lanes.last, l, impulse);
}

/// Where contacts, rows and bodies are.
struct Source {
  ConstView<Contact> contacts;
  ConstView<ContactRow> rows;
  ConstView<Vec3> couples;
  ConstView<SolverBody> bodies;
  const Body* lane_bodies;
  std::int32_t nobody;

  void put_ends(Ends& ends, int l, std::int32_t c) const {
    ends.i[l] = c == none ? nobody : contacts[c].i;
    ends.j[l] = c == none ? nobody : contacts[c].j;
  }
  /// Of batches that have any.
  void put_rolling(View<Rolling> rolling, std::int64_t b, int l, std::int32_t c) const {
    if (rolling.size() == 0) return;
    put(rolling[b].reach, l, contacts[c].rolling_reach);
    start_from(rolling[b].couple, l, couples[c]);
  }
};

struct LoadBalls {
  Source from;
  BallSource pairs;
  ConstView<Members> members;
  View<BallBatch> batches;
  View<BallParting> partings;
  View<Rolling> rolling;
  void operator()(std::int64_t b) const {
    BallBatch& batch = batches[b];
    BallParting& parting = partings[b];
    if (members[b].are_pairs) {
      kernels().prepare_balls(pairs, batch, parting);
      return;
    }
    parting.apart = parting.driven = 0;
    parting.pushed = {};
    for (int l = 0; l < width; ++l) {
      const std::int32_t c = members[b].contact[l];
      from.put_ends(batch.ends, l, c);
      parting.loaded[l] = parting.flying[l] = 0;
      if (c == none) {
        put(batch.normal, l, Vec3::Zero());
        for (Lane* lane : {&batch.arm_i, &batch.arm_j, &batch.friction, &batch.target, &batch.tangent_mass})
          put(*lane, l, 0);
        put(batch.normal_mass, l, 1);
        start_from(batch.impulse, l, Vec3::Zero());
        put(parting.gap, l, 0);
        put(parting.bend, l, 0);
        put(parting.cap, l, 0);
        continue;
      }
      const Contact& contact = from.contacts[c];
      const ContactRow& row = from.rows[members[b].row[l]];
      put(batch.normal, l, contact.normal);
      put(batch.arm_i, l, contact.normal.dot(row.arm_i));
      put(batch.arm_j, l, contact.normal.dot(row.arm_j));
      put(batch.friction, l, contact.friction);
      put(batch.target, l, row.target);
      put(batch.normal_mass, l, row.normal_mass);
      put(batch.tangent_mass, l, row.tangent_mass);
      start_from(batch.impulse, l, row.impulse);
      from.put_rolling(rolling, b, l, c);
      put(parting.gap, l, row.gap);
      put(parting.bend, l, row.bend);
      put(parting.cap, l, tolerance::correction_cap * contact.size);
      if (contact.flying || contact.lead != 0) parting.apart |= 1 << l;
    }
    parting.ends = batch.ends;
    parting.normal = batch.normal;
    parting.normal_mass = batch.normal_mass;
  }
};

struct LoadPoints {
  Source from;
  ConstView<Members> members;
  View<PointBatch> batches;
  View<PointRow> rows;
  View<PointParting> partings;
  View<Rolling> rolling;
  void operator()(std::int64_t b) const {
    PointBatch& batch = batches[b];
    batch.apart = 0;
    for (int l = 0; l < width; ++l) {
      const std::int32_t c = members[b].contact[l];
      from.put_ends(batch.ends, l, c);
      if (c == none) {
        put(batch.normal, l, Vec3::Zero());
        put(batch.cap, l, 0);
        put(batch.friction, l, 0);
        put(batch.inertia_i, l, Mat3::Zero());
        put(batch.inertia_j, l, Mat3::Zero());
        const ContactRow no_row = row_at(Vec3::Zero(), Vec3::Zero(), 0);
        for (int k = 0; k < batch.count; ++k) load(no_row, batch.first_row + k, l);
        continue;
      }
      const Contact& contact = from.contacts[c];
      put(batch.normal, l, contact.normal);
      put(batch.cap, l, tolerance::correction_cap * contact.size);
      put(batch.friction, l, contact.friction);
      from.put_rolling(rolling, b, l, c);
      put(batch.inertia_i, l, from.bodies[contact.i].inverse_inertia);
      put(batch.inertia_j, l, from.bodies[contact.j].inverse_inertia);
      bool apart = contact.flying || contact.lead != 0;
      for (int k = 0; k < batch.count; ++k) {
        const ContactRow& row = from.rows[contact.first_row + k];
        load(row, batch.first_row + k, l);
        apart = apart || row.bend != 0;
      }
      if (apart) batch.apart |= 1 << l;
    }
    kernels().prepare_points(batch, &rows[batch.first_row], &partings[batch.first_row], from.lane_bodies);
  }

  void load(const ContactRow& from_row, std::int64_t r, int l) const {
    PointRow& row = rows[r];
    put(row.arm_i, l, from_row.arm_i);
    put(row.arm_j, l, from_row.arm_j);
    put(row.target, l, from_row.target);
    start_from(row.impulse, l, from_row.impulse);
    put(partings[r].gap, l, from_row.gap);
  }
};

struct TakeBallImpulses {
  ConstView<ContactRow> from;
  ConstView<Members> members;
  View<BallBatch> batches;
  void operator()(std::int64_t b) const {
    for (int l = 0; l < width; ++l) {
      const std::int32_t c = members[b].contact[l];
      if (c != none) start_from(batches[b].impulse, l, from[members[b].row[l]].impulse);
    }
  }
};

struct TakePointImpulses {
  ConstView<ContactRow> from;
  ConstView<Members> members;
  ConstView<PointBatch> batches;
  View<PointRow> rows;
  void operator()(std::int64_t b) const {
    for (int l = 0; l < width; ++l) {
      const std::int32_t c = members[b].contact[l];
      for (int k = 0; c != none && k < batches[b].count; ++k) {
        start_from(rows[batches[b].first_row + k].impulse, l, from[members[b].row[l] + k].impulse);
      }
    }
  }
};

/// Where impulses go back to.
struct Target {
  View<ContactRow> rows;
  View<ImpulseChange> change;  ///< empty if nobody asks

  void store(const LaneImpulse& lanes, int l, std::int32_t c, std::int64_t first_row, int k) const {
    ContactRow& row = rows[first_row + k];
    row.impulse = take(lanes.impulse, l);
    if (change.size() == 0) return;
    if (k == 0) change[c] = {};
    change[c].add(row, row.impulse - take(lanes.last, l));
  }
};

struct StoreBallImpulses {
  Target to;
  ConstView<Members> members;
  ConstView<BallBatch> batches;
  void operator()(std::int64_t b) const {
    for (int l = 0; l < width; ++l) {
      const std::int32_t c = members[b].contact[l];
      if (c != none) to.store(batches[b].impulse, l, c, members[b].row[l], 0);
    }
  }
};

struct StorePointImpulses {
  Target to;
  ConstView<Members> members;
  ConstView<PointBatch> batches;
  ConstView<PointRow> rows;
  void operator()(std::int64_t b) const {
    for (int l = 0; l < width; ++l) {
      const std::int32_t c = members[b].contact[l];
      for (int k = 0; c != none && k < batches[b].count; ++k) {
        to.store(rows[batches[b].first_row + k].impulse, l, c, members[b].row[l], k);
      }
    }
  }
};

struct ClearRolling {
  View<Rolling> rolling;
  void operator()(std::int64_t b) const { rolling[b] = {}; }
};

struct StoreCouples {
  ConstView<Members> members;
  ConstView<Rolling> rolling;
  View<Vec3> couples;
  void operator()(std::int64_t b) const {
    for (int l = 0; l < width; ++l) {
      const std::int32_t c = members[b].contact[l];
      if (c != none) couples[c] = take(rolling[b].couple.impulse, l);
    }
  }
};

/// Directions start anew.
struct StopRolling {
  View<Rolling> rolling;
  void operator()(std::int64_t b) const { rolling[b].couple.last = rolling[b].couple.impulse; }
};

struct StoreMasses {
  ConstView<Members> members;
  ConstView<PointBatch> batches;
  ConstView<PointRow> from;
  View<ContactRow> rows;
  void operator()(std::int64_t b) const {
    for (int l = 0; l < width; ++l) {
      for (int k = 0; members[b].contact[l] != none && k < batches[b].count; ++k) {
        ContactRow& row = rows[members[b].row[l] + k];
        row.normal_mass = from[batches[b].first_row + k].normal_mass.at[l];
        row.tangent_mass = from[batches[b].first_row + k].tangent_mass.at[l];
      }
    }
  }
};

/// Lanes of pairs that nobody takes, from the first of them on.
void leave(BallBatch& batch, BallParting& parting, int first, std::int32_t nobody) {
  for (int l = first; l < width; ++l) {
    batch.ends.i[l] = batch.ends.j[l] = nobody;
    put(batch.friction, l, 0);
    put(batch.impulse.impulse, l, Vec3::Zero());
    parting.loaded[l] = parting.flying[l] = 0;
  }
}

}  // namespace

void arrange(const Coloring& coloring, ConstView<Contact> contacts, std::int32_t nobody, bool rolls,
             Batches& batches) {
  const auto colors = static_cast<std::size_t>(coloring.colors());
  batches.nobody = nobody;
  batches.lane_of.resize(std::ssize(coloring.order) - contacts.size());
  batches.last_is_serial = coloring.last_is_serial;
  // Contacts that share a free body, in the serial colour, share no batch.
  const auto is_serial = [&](std::size_t color) { return coloring.last_is_serial && color + 1 == colors; };
  const auto kind_at = [&](std::int64_t place) {
    const std::int32_t c = coloring.order[static_cast<std::size_t>(place)];
    return static_cast<std::size_t>(c < contacts.size() ? kind_of(contacts[c]) : 0);
  };
  std::vector<std::array<std::int64_t, kinds>>& next = batches.next_lane;
  next.assign(colors, {});
  std::int64_t balls = 0, points = 0, rows = 0;
  for (std::size_t color = 0; color < colors; ++color) {
    std::array<std::int64_t, kinds> counts{};
    for (std::int64_t k = coloring.color_begin[color]; k < coloring.color_begin[color + 1]; ++k)
      ++counts[kind_at(k)];
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const std::int64_t batches_of_kind =
          is_serial(color) ? counts[kind] : (counts[kind] + width - 1) / width;
      std::int64_t& begin = is_of_balls(kind) ? balls : points;
      next[color][kind] = begin * width;
      begin += batches_of_kind;
      if (!is_of_balls(kind)) rows += static_cast<std::int64_t>(kind - 1) * batches_of_kind;
    }
  }
  batches.balls.resize(balls);
  batches.partings.resize(batches.balls.size());
  batches.ball_members.resize(batches.balls.size());
  batches.points.resize(points);
  batches.point_members.resize(batches.points.size());
  batches.rows.resize(rows);
  batches.point_partings.resize(rows);
  batches.ball_rolling.resize(rolls ? balls : 0);
  batches.point_rolling.resize(rolls ? points : 0);
  for (Array<Rolling, Host>* rolling : {&batches.ball_rolling, &batches.point_rolling})
    parallel::for_each<Host>("lanes.reset", rolling->size(), ClearRolling{rolling->view()});
  parallel::fill("lanes.reset", batches.ball_members, nothing);
  parallel::fill("lanes.reset", batches.point_members, nothing);
  // Of the contacts given, and of the pairs of balls after them, each in its own order.
  const std::int64_t pairs = std::ssize(coloring.order) - contacts.size();
  const auto slab_of = [&](std::int64_t c) {
    return c < contacts.size() ? c * slabs / contacts.size() : (c - contacts.size()) * slabs / pairs;
  };
  batches.slab_begin.resize(colors);
  for (std::size_t color = 0; color < colors; ++color) {
    std::array<std::int64_t, kinds> slab{};  // the next to begin
    for (std::int64_t k = coloring.color_begin[color]; k < coloring.color_begin[color + 1]; ++k) {
      const std::int32_t c = coloring.order[static_cast<std::size_t>(k)];
      const std::size_t kind = kind_at(k);
      std::int64_t& lane = next[color][kind];
      Array<Members, Host>& members = is_of_balls(kind) ? batches.ball_members : batches.point_members;
      Members& group = members.view()[lane / width];
      if (lane % width == 0) {
        for (const std::int64_t own = slab_of(c); slab[kind] <= own; ++slab[kind])
          batches.slab_begin[color][kind][static_cast<std::size_t>(slab[kind])] = lane / width;
      }
      if (kind == 0) {
        group.are_pairs = true;
        batches.lane_of.view()[c - contacts.size()] = static_cast<std::int32_t>(lane);
      } else {
        group.contact[lane % width] = c;
        group.row[lane % width] = contacts[c].first_row;
      }
      if (!is_of_balls(kind)) batches.points.view()[lane / width].count = static_cast<std::int32_t>(kind - 1);
      const bool is_last = k + 1 == coloring.color_begin[color + 1];  // pairs are, in each colour
      if (kind == 0 && (is_serial(color) || is_last))
        leave(batches.balls.view()[lane / width], batches.partings.view()[lane / width],
              static_cast<int>(lane % width) + 1, nobody);
      lane += is_serial(color) ? width : 1;
    }
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const std::int64_t end = (next[color][kind] + width - 1) / width;
      for (; slab[kind] <= slabs; ++slab[kind])
        batches.slab_begin[color][kind][static_cast<std::size_t>(slab[kind])] = end;
    }
  }
  std::int64_t first_row = 0;
  for (PointBatch& batch : batches.points.view()) {
    batch.first_row = first_row;
    first_row += batch.count;
  }
}

void load(ConstView<Contact> contacts, ConstView<ContactRow> rows, ConstView<Vec3> couples,
          ConstView<SolverBody> bodies, const Body* lane_bodies, const BallSource& balls, Batches& batches) {
  const Source from{contacts, rows, couples, bodies, lane_bodies, batches.nobody};
  for_each_batch("lanes.load", batches,
                 LoadBalls{from, balls, batches.ball_members.view(), batches.balls.view(),
                           batches.partings.view(), batches.ball_rolling.view()},
                 LoadPoints{from, batches.point_members.view(), batches.points.view(), batches.rows.view(),
                            batches.point_partings.view(), batches.point_rolling.view()});
}

void store_masses(const Batches& batches, View<ContactRow> rows) {
  parallel::for_each<Host>(
      "lanes.masses", batches.points.size(),
      StoreMasses{batches.point_members.view(), batches.points.view(), batches.rows.view(), rows});
}

void take_impulses(ConstView<ContactRow> rows, Batches& batches) {
  parallel::for_each<Host>("lanes.impulses", batches.balls.size(),
                           TakeBallImpulses{rows, batches.ball_members.view(), batches.balls.view()});
  parallel::for_each<Host>(
      "lanes.impulses", batches.points.size(),
      TakePointImpulses{rows, batches.point_members.view(), batches.points.view(), batches.rows.view()});
  for (Array<Rolling, Host>* rolling : {&batches.ball_rolling, &batches.point_rolling})
    parallel::for_each<Host>("lanes.impulses", rolling->size(), StopRolling{rolling->view()});
}

void scale_impulse(Batches& batches, std::int64_t batch, int l, double scale) {
  const auto scale_lane = [&](LaneImpulse& lanes) { put(lanes.impulse, l, scale * take(lanes.impulse, l)); };
  const std::int64_t balls = batches.balls.size();
  if (batch < balls) {
    scale_lane(batches.balls.view()[batch].impulse);
    if (batches.rolls()) scale_lane(batches.ball_rolling.view()[batch].couple);
    return;
  }
  const PointBatch& points = batches.points.view()[batch - balls];
  if (batches.rolls()) scale_lane(batches.point_rolling.view()[batch - balls].couple);
  for (int k = 0; k < points.count; ++k) scale_lane(batches.rows.view()[points.first_row + k].impulse);
}

void store_impulses(const Batches& batches, View<ContactRow> rows, View<ImpulseChange> change) {
  const Target to{rows, change};
  parallel::for_each<Host>("lanes.store", batches.balls.size(),
                           StoreBallImpulses{to, batches.ball_members.view(), batches.balls.view()});
  parallel::for_each<Host>(
      "lanes.store", batches.points.size(),
      StorePointImpulses{to, batches.point_members.view(), batches.points.view(), batches.rows.view()});
}

void store_couples(const Batches& batches, View<Vec3> couples) {
  parallel::for_each<Host>("lanes.store", batches.ball_rolling.size(),
                           StoreCouples{batches.ball_members.view(), batches.ball_rolling.view(), couples});
  parallel::for_each<Host>("lanes.store", batches.point_rolling.size(),
                           StoreCouples{batches.point_members.view(), batches.point_rolling.view(), couples});
}

}  // namespace scree::lanes
