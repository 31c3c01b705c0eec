// Every tolerance of scree: unit, purpose, what changing it does, and how it relates to the others.
// Lengths are relative to a body's smallest_size, so that a scene in mm and in m gives the same motion.
#pragma once

#include <limits>

namespace scree::tolerance {

/// Gap under which a contact counts as closed (of smallest_size). Contacts rest inside this shell instead of
/// flickering at 0: without it a box on four corners jitters. Larger: visible gaps; must stay under
/// contact_slack.
inline constexpr double closed_gap = 1e-5;

/// Extra reach of contact detection beyond the distance that bodies can travel in a step (of smallest_size).
/// Larger: more contacts to solve that never close.
inline constexpr double contact_slack = 0.02;

/// How much further the boxes of the broad phase reach (of smallest_size): the pairs last until a body has
/// moved about this far. Larger: fewer broad phases, more pairs for the narrow phase. Never changes a result.
inline constexpr double pair_skin = 0.03;
/// How far most bodies may travel while the pairs last (likewise): boxes of faster ones have room for as long
/// a time. Larger: likewise.
inline constexpr double pair_travel = 0.05;
/// That time at most, in steps.
inline constexpr double most_pair_steps = 16;

/// Safety factor on the distance that a body can travel in a step, for what impacts add to its speed.
inline constexpr double travel_factor = 1.05;

/// Accuracy of the least loaded contact, relative to its impulse, under which the contacts of a substep are
/// not judged together but island by island.
inline constexpr double least_load_accuracy = 1e-6;

/// Share of its gap that a point must be seen to close in the rest of a substep to count as one that meets
/// there: its row takes the midpoint's spin, and what tumbles has another one when it is seen.
inline constexpr double likely_closing = 0.75;

/// Share of an overlap that one visit of the position correction removes. 1 can collapse a pile, 0.5 takes
/// three times as many sweeps.
inline constexpr double correction_share = 0.8;
/// Overlap of the deepest contact (of smallest_size) at which it stops.
inline constexpr double corrected_overlap = 1e-7;
/// The same of a heap, in which the deepest is one of many, and of the mean of the overlaps of balls: the
/// rest is for the next substeps. Smaller: a heap at rest takes more sweeps, and overlaps less.
inline constexpr double heap_overlap = 2e-3;
inline constexpr double heap_mean_overlap = 1e-5;
/// The same mean of bodies that share several points, whose overlaps turn them.
inline constexpr double shared_mean_overlap = 1e-6;
/// Overlap that a substep may leave to be corrected (of the smaller smallest_size): after more, the next step
/// is taken in twice as many substeps, if their number is free. It falls with the square of the substep's
/// length. Smaller: impacts of many bodies at once cost more and are more accurate. This and all overlaps
/// below down to `mean_overlap_left` are for response.quality 1, by which they are divided.
inline constexpr double substep_overlap = 0.06;
/// The same of a heap, in which the deepest is an extreme of many: from here on two bodies may part to the
/// wrong side. Larger: what falls into a heap sinks deeper before the substeps follow.
inline constexpr double heap_substep_overlap = 0.5;
/// Under this much (likewise) the next step is taken in half as many. Must be under a quarter of the first,
/// or their number flickers.
inline constexpr double coarser_overlap = 0.012;
/// And after so many steps between the two, as well: what is wedged would ask for finer steps for good, which
/// do not part it. Fewer: the deepest overlaps come back more often.
inline constexpr int wedged_steps = 32;
/// Overlaps that the steps of a heap in motion may leave, position correction included: the deepest, and the
/// mean of all (of the smaller smallest_size). Substeps are chosen for them. Larger: fewer, and errors grow.
inline constexpr double worst_overlap_left = 2e-2;
inline constexpr double mean_overlap_left = 2e-4;
/// Most substeps that a step takes by itself. Larger: fast scenes cost more.
inline constexpr int most_substeps = 4;
/// Substeps for each one of a step that failed, when it is taken again.
inline constexpr int redo_substeps = 4;
/// Energy that may come or go in a step without the ledger explaining it (of the energy scale); a step with
/// more has failed. Far above what rounding does: 1e-14, and 1e-10 a kilometre from the origin.
inline constexpr double unexplained_energy = 1e-6;
/// The same where impulses are in float: 1e-5 was seen as a heavy ball went through a wall of boxes.
inline constexpr double unexplained_energy_mixed = 1e-3;
/// Largest correction of one body in one step (of smallest_size): deep overlaps part gently.
inline constexpr double correction_cap = 0.2;

/// Restitution threshold in units of |gravity| * step * (1 - e): slower approaches do not bounce, so that
/// bodies come to rest. The bounces left out would be over within twice as many substeps. Larger: rest comes
/// sooner.
inline constexpr double restitution_threshold = 2.0;
/// The same in the accurate mode, where contacts at rest are solved well enough to stay under it.
inline constexpr double accurate_restitution_threshold = 0.5;
/// Least 1 - e in it for e < 1: it bounds the bounces of a body in one substep, to half its inverse over the
/// threshold above.
inline constexpr double least_loss = 0.02;

/// An approach that would go on for this much (of the pair's smaller smallest_size) by the end of a substep
/// is an impact at its own time, whatever the pair: the midpoint's normals say nothing of bodies that are
/// through one another by then. Smaller: impacts where the response would do.
inline constexpr double deep_approach = 0.25;

/// Mass, of the other's, from which on a body is so heavy that it does not wait for its impacts with lighter
/// ones, nor they for each other's. Smaller: fewer rounds of impacts, and what one gives to the heavy body is
/// seen by the next only in the next round.
inline constexpr double heavy_ratio = 100;

/// Slowest approach that can count as an impact, relative to the bodies' speeds: under it, it is rounding.
inline constexpr double closing_speed = 1e-12;
/// Share of its approach's energy that an impact may gain before its impulses are scaled down: rounding.
inline constexpr double impact_gain = 1e-12;

/// Change of the impulses in one sweep at which they have converged (of their size): few contacts are solved
/// to the first, of a heap what is beyond the second is left to the next substeps. response.tolerance
/// replaces both. Larger: towers rock; heaps come to rest too dense.
inline constexpr double response_change = 1e-10;
inline constexpr double heap_change = 3e-3;
/// The same of a heap that flows, at most. Larger: they overlap more; smaller: more sweeps, and
/// overlaps that the motion makes anew (docs/decisions/0052 has the front).
inline constexpr double heap_change_in_flow = 2e-2;
/// Mean overlap of the contacts of a heap that flows, of the smaller size, under which its change in one
/// sweep may be twice as large in the next substeps, and over which half as large. Larger: fewer sweeps, and
/// heaps that flow overlap more.
inline constexpr double little_overlap_in_flow = 2e-4;
inline constexpr double much_overlap_in_flow = 4e-4;
/// Power that normal impulses have on what they leave undone (of that on all they change), over which a heap
/// is swept twice as often in the next substeps, and under which half as often: it shows slow modes of many
/// layers, of which one sweep's change tells nothing. Smaller: heaps come to rest sooner, and cost more until
/// then.
inline constexpr double residual_power = 0.01;
inline constexpr double done_power = 0.004;
/// Under this much (likewise) a heap is swept half as often as one usually is at least, and then a third;
/// over the second no longer that.
inline constexpr double least_sweeps_power = 0.0004;
inline constexpr double stirring_power = 0.001;
/// What is dissipated in a heap that flows leaves 0.01 to 0.08 of it undone; slow modes 0.3 to 1. Larger:
/// heaps come to rest later. Smaller: heaps in motion are swept more often, which changes nothing in them.
inline constexpr double residual_of_dissipated = 0.1;
/// Of the power of all impulses, what is dissipated in a heap that moves: 0.5 to 1 where it flows, under 0.1
/// at rest.
inline constexpr double moving_power = 0.25;
/// And in one that flows as a whole: 0.8 to 2. What falls on others loses the half of that power, and what it
/// rubs away besides: boxes that rain on others 0.5 to 0.6, a deep heap that lands layer by layer 0.65 to
/// 0.71. Larger: what flows is swept until nothing changes any more; smaller: deep heaps sink in while they
/// land, and boxes that come to rest bounce on what is left.
inline constexpr double flowing_power = 0.75;
/// Of the power of one substep's impulses, what is undone as it is when a heap has just fallen on its ground;
/// where it flows, 0.005 to 0.09. Larger: deep heaps sink in while they land. Smaller: what only moves is
/// swept as often as any.
inline constexpr double all_residual = 0.5;
/// What is that many times too much is followed at once, or by two degrees.
inline constexpr double much_residual = 4;
/// The least change with impulses in float, whose rounding is 1e-7.
inline constexpr double mixed_change = 2e-6;

/// Speed at which a contact may part before gravity's kick and still be held at 0 by it, in units of
/// |gravity| * step. Smaller: the noise of resting faces becomes targets that no rigid body can meet at all
/// points, and solving them takes long. Larger: held contacts gain more, before their island is scaled down.
inline constexpr double parting_speed = 1e-5;

/// Speed along a contact (of that before the substep) under which what slid may have come to stick: on a
/// slope, the energy that sticking would gain is taken out of the impulses and leaves some of it.
inline constexpr double sticking_slip = 0.1;
/// Share of a substep under which it is not cut where a contact comes to stick: the distance that it goes
/// wrong by is that share of half the way slid in it. Smaller: more substeps.
inline constexpr double least_cut = 1e-4;
/// Way along a contact in a substep (of smallest_size) under which it is at rest for that. Smaller: rounding
/// is cut too.
inline constexpr double least_slide = 1e-9;

/// Energy that the impulses of an island may gain before they are scaled down, as a share of half p.W p: what
/// the tolerance of the response leaves.
inline constexpr double response_gain = 1e-10;
/// The same where impulses are found in float: the rounding of velocities may be thousands of times that of
/// what impulses change. Larger: gains of energy pass. Smaller: rounding is taken for a gain.
inline constexpr double mixed_response_gain = 1e-3;

/// By how much contacts in flight may close faster than they do before they count as touched, relative.
inline constexpr double flight_margin = 1e-9;
/// Roundings of the bodies' speeds, in the precision of the impulses, that are added to that margin.
inline constexpr double flight_roundings = 8;
/// Change at which the time of an impact is found (of the substep), and at which the impulses of one impact
/// are (of their size). Both are met to rounding; energy depends on neither.
inline constexpr double impact_time = 1e-15;
inline constexpr double impact_residual = 1e-15;
/// Rounding of the distance of two balls, at which the time of their impact cannot be found better.
inline constexpr double impact_distance = 1e-14;
/// How far beyond the level a search aims at when it looks for a touch, of touching_gap. Larger: bodies at
/// rest with e = 1 bounce more; smaller: the search ends before the touch, and goes on.
inline constexpr double touch_aim = 0.0625;
/// Under this much (likewise) a change that has stopped to fall is rounding of the bodies' velocities.
inline constexpr double impact_rounding = 1e-10;

/// Gap at which bodies touch in the search for the time of an impact (of the smaller smallest_size): rounding
/// of positions. Smaller: the search may step through a contact. Must stay well under closed_gap.
inline constexpr double touching_gap = 1e-12;
/// How far (likewise) the search may go on where the gap is next to nothing and bodies part or slide. Larger:
/// a brief touch in between may be missed; smaller: more looks.
inline constexpr double search_advance = 0.1;

/// Turn of a body in a flight (rad) from which on nothing is told of the flight from its ends.
inline constexpr double far_turn = 1.0;
/// Turn of a free body in one step of its splitting (rad); what turns further goes in several. Larger: less
/// accurate, faster.
inline constexpr double split_turn = 0.5;
/// Turn of a free body in one step (rad) whose cube is rounding: it turns about its mean spin.
inline constexpr double hardly_a_turn = 5e-6;
static_assert(hardly_a_turn * hardly_a_turn * hardly_a_turn < std::numeric_limits<double>::epsilon());
/// The same of the turn that restores its energy afterwards; beyond it the splitting has failed, and nothing
/// is restored.
inline constexpr double energy_turn = 0.1;
/// Share of its energy that is rounding then.
inline constexpr double energy_rounding = 4e-16;
/// Slope of the energy per radian (of the energy) under which the body turns about a principal axis, where
/// there is nothing to restore.
inline constexpr double energy_slope = 1e-8;

/// Share of the response's tolerance to which the direct solver goes on, so that the next substep starts from
/// a solution.
inline constexpr double direct_share = 0.01;

/// Difference from 1 under which a quaternion's length is that of a unit one, but for rounding. It must
/// exceed what normalising leaves, some 1e-16: a state that was written is then read back to the bit.
inline constexpr double unit_length = 1e-14;

/// A last step shorter than this share of a step is rounding of end / step, and none.
inline constexpr double step_count = 1e-9;

static_assert(moving_power < flowing_power);
static_assert(least_sweeps_power < stirring_power && stirring_power < done_power);
static_assert(done_power < residual_power);
static_assert(closed_gap < contact_slack);
static_assert(corrected_overlap < closed_gap);
static_assert(4 * coarser_overlap < substep_overlap);
static_assert(touching_gap < closed_gap);

// Narrow phase. Lengths are of the smaller smallest_size of the pair.

/// Rounding of the square of a distance, by which bodies must be farther apart than their margins before
/// their test is left out.
inline constexpr double far_rounding = 1e-12;

/// Distance of two sphere centres under which their direction is rounding noise (of the sum of the radii).
inline constexpr double coincident = 1e-14;

/// Cosine of the angle between the normal of a contact at an edge or a corner and that of a face, from which
/// on what lies over the face is part of the contact. Smaller: more such contacts have more points.
inline constexpr double over_face_cosine = 0.95;

/// Sine of the angle under which the cross product of two box edges is too short to be a separating axis. The
/// overlap along any axis is exact whatever its rounding; a smaller value only adds axes that repeat the
/// faces'.
inline constexpr double parallel_axes = 1e-6;
/// Sine of the angle under which two box edges in contact count as parallel: their closest points are then
/// badly placed, and faces carry the contact. Must exceed parallel_axes.
inline constexpr double parallel_edges = 1e-3;

/// By how much an axis must separate two boxes better than a preferred one to replace it: a share of the
/// preferred separation, plus a length. Faces are preferred to edges and the first body's to the second's, so
/// that noise in a resting stack does not change the manifold. Larger: steadier, but overlaps are
/// overestimated by as much. The length must exceed same_feature.
inline constexpr double axis_preference = 0.3;
inline constexpr double axis_preference_length = 1e-4;

/// Length under which two points of a box-box contact count as equally deep, and a vertex as still over a
/// face that it has left: noise in aligned stacks does not change the features.
inline constexpr double same_feature = 1e-6;

/// Overlap that libccd's direction may have beyond the least that is known before it is refused.
inline constexpr double ccd_excess = 1e-6;

/// By how much a unit normal may leave the cone of a mesh's edge or vertex: rounding, where neither of two
/// triangles would have the contact otherwise. A bend under this is flat.
inline constexpr double cone_slack = 1e-9;

/// Cosine short of 1 over which a face is in contact as a whole, and not only its edge or vertex that is
/// nearest: 0.06 rad. Larger: points that are far from touching.
inline constexpr double face_cosine = 2e-3;

/// Relative change of a distance at which the search for it ends; some roundings.
inline constexpr double distance_change = 1e-15;
/// Distance of two convex bodies under which they count as overlapping in that search, and by which they are
/// then moved apart to look again (of the smaller smallest_size). Must exceed its rounding.
inline constexpr double overlapping = 1e-10;
static_assert(overlapping < closed_gap);

/// Distance from which on the nearest points of two cores tell their direction to rounding (of the size).
inline constexpr double clear_gap = 1e-4;
static_assert(clear_gap > overlapping);
/// How far bodies are moved apart to see where they are nearest (of the size); small against their features.
inline constexpr double clear_distance = 0.05;
/// Overlap under which the best of the faces and edges leads to the best of all directions (of the size).
inline constexpr double shallow_overlap = 1e-3;

/// Directions in a scene that differ by no more (rad) are one.
inline constexpr double same_direction = 1e-9;

/// Thickness of a triangle (of its longest extent) under which it is none, and distance from a face under
/// which a point is in it.
inline constexpr double flat = 1e-10;
/// The same of a hull's points. Coordinates in single precision, or with six digits, do not tell thinner ones
/// from a plane; hulls of a millionth stay.
inline constexpr double thin_hull = 2e-7;
/// Distance of two points of a hull, and of a point from a plane, that counts as none (of its longest extent,
/// but of so many times its thickness at most). It must exceed the noise of points in single precision, 1e-7,
/// and should that of six digits: or a face falls into several, and the body rests on one of them. Larger:
/// facets of fine hulls are lost.
inline constexpr double coplanar = 1e-6;
inline constexpr double coplanar_thicknesses = 5;
/// Times the distance that counts as none by which a point may be outside of a hull's face, or a corner off
/// its plane; beyond, points that are farther apart count as one. A million adversarial sets come to 15, but
/// for clusters of points that are only just not equal (decision 0040).
inline constexpr double most_off_face = 20;
// A face's corners touch all at once: the smallest size is half the thickness.
static_assert(2 * coplanar * coplanar_thicknesses <= closed_gap);
/// Distance under which corners of a mesh count as one, and a corner as on an edge: the smaller of a share of
/// the mesh's size (the diagonal of its box) and a share of the shortest edge at the corners, so that nothing
/// is joined that edges tell apart. The first covers two copies of a corner that are each 1e-5 of the size
/// off along every axis. Larger: slits and thin sheets close; smaller: cracks stay.
inline constexpr double weld_size = 4e-5;
inline constexpr double weld_edge = 1e-2;
/// But at least this (of the size): shorter edges are rounding.
inline constexpr double weld_least = 1e-9;
static_assert(flat < weld_least && weld_least < weld_size);
/// Difference of two principal moments, and products of inertia, that are rounding (of the largest moment).
inline constexpr double equal_moments = 1e-12;

static_assert(parallel_axes < parallel_edges);
static_assert(same_feature < axis_preference_length);

}  // namespace scree::tolerance
