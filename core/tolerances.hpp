// All tolerances of scree: unit, purpose, effect of a change, and relation to the others. Lengths are
// relative to a body's smallest_size, so that a scene in mm and one in m give the same motion.
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

/// Extra reach of the boxes of the broad phase beyond that of contact detection (of smallest_size): the pairs
/// last until a body has moved about this far. Larger: fewer broad phases, more pairs for the narrow phase.
/// Which pairs are looked at decides about the order of contacts, and so about rounding, but no pair that may
/// touch is left out.
inline constexpr double pair_skin = 0.03;
/// Share of a substep by which pairs may have lasted for less than planned, because times are rounded. It
/// must exceed the rounding of the run's time, and be well under 1.
inline constexpr double pair_life_rounding = 1e-6;

/// Mean travel of the bodies within a substep (of smallest_size) under which contacts are searched within the
/// whole travel of each body, and not only within its travel relative to others, and boxes of the broad phase
/// are around places and not around paths. It is as large as contact_slack: below, the travel adds hardly any
/// contacts. Larger: more contacts to solve that never close.
inline constexpr double little_travel = contact_slack;

/// Safety factor on the distance that a body can travel in a step, because impacts add to its speed.
inline constexpr double travel_factor = 1.05;

/// Required accuracy of the least loaded contact, relative to its impulse. If the tolerance on all contacts
/// of a substep together does not ensure it, they are judged island by island.
inline constexpr double least_load_accuracy = 1e-6;

/// Share of its gap that a point must close in the rest of a substep, as its velocity indicates, to count as
/// one that meets there. It is less than 1 because the row of the contact uses the spin at the midpoint,
/// while a tumbling body has another spin at the instant at which the pair is looked at.
inline constexpr double likely_closing = 0.75;

/// Share of an overlap that one visit of the position correction removes. 1 can collapse a pile, 0.5 takes
/// three times as many sweeps.
inline constexpr double correction_share = 0.8;
/// Overlap of the deepest contact at which the position correction of few contacts stops (of smallest_size).
inline constexpr double corrected_overlap = 1e-7;
/// Overlaps at which the position correction of a heap stops (of smallest_size): the deepest, which is one of
/// many, and the mean of the overlaps of balls. The rest is left to the next substeps. Smaller: a heap at
/// rest takes more sweeps, and overlaps less.
inline constexpr double heap_overlap = 2e-3;
inline constexpr double heap_mean_overlap = 1e-5;
/// Mean overlap at which it stops in a heap of bodies that share several points (of smallest_size): such
/// overlaps turn the bodies.
inline constexpr double shared_mean_overlap = 1e-6;
/// Overlap that a substep of few contacts may leave to the position correction (of the smaller
/// smallest_size). After a deeper one, the next step is taken in twice as many substeps, if the scene leaves
/// their number open. The overlap falls with the square of the substep's length. Smaller: impacts of many
/// bodies at once cost more and are more accurate. This overlap and all below, down to `mean_overlap_left`,
/// hold for response.quality 1; they are divided by it.
inline constexpr double substep_overlap = 0.06;
/// Overlap that a substep of a heap may leave to the position correction (of the smaller smallest_size); in a
/// heap the deepest one is an extreme of many. From here on two bodies may be pushed apart to the wrong side.
/// Larger: bodies that fall into a heap sink deeper before the number of substeps rises.
inline constexpr double heap_substep_overlap = 0.5;
/// Overlap under which the next step is taken in half as many substeps (of the smaller smallest_size). It
/// must be under a quarter of substep_overlap, or the number of substeps flickers.
inline constexpr double coarser_overlap = 0.012;
/// Number of steps with overlaps between coarser_overlap and substep_overlap after which the number of
/// substeps is halved, too: wedged bodies would otherwise keep finer steps for ever, which do not move them
/// apart. Fewer: the deepest overlaps come back more often.
inline constexpr int wedged_steps = 32;
/// Overlaps that the steps of a heap in motion may leave after position correction: the deepest, and the mean
/// of all (of the smaller smallest_size). The number of substeps is chosen for them. Larger: fewer substeps,
/// and errors grow. The correction takes away more than half of the overlaps that much_overlap_in_flow
/// bounds, so that a heap is swept more before it takes more substeps, which cost more (docs/decisions/0059).
inline constexpr double worst_overlap_left = 2e-2;
inline constexpr double mean_overlap_left = 5e-4;
/// Deepest overlap to which the position correction of a heap in motion goes on. It is so far under
/// worst_overlap_left that a correction that gets there allows for fewer substeps. Smaller: more sweeps.
inline constexpr double worst_corrected_overlap = 0.6 * worst_overlap_left;
/// Largest number of substeps in which a step is taken if the scene leaves it open, at response.quality 1.
/// Larger: fast scenes cost more.
inline constexpr int most_substeps = 4;
/// Factor on the number of substeps when a step that failed is taken again.
inline constexpr int redo_substeps = 4;
/// Energy that may be gained or lost in a step without an explanation in the ledger (of the energy scale); a
/// step with more has failed. It is far above rounding, which is 1e-14, and 1e-10 at a kilometre from the
/// origin.
inline constexpr double unexplained_energy = 1e-6;
/// Bound on that energy where impulses are in float: 1e-5 was observed when a heavy ball went through a wall
/// of boxes.
inline constexpr double unexplained_energy_mixed = 1e-3;
/// Largest position correction of one body in one step (of smallest_size), so that deep overlaps are removed
/// gently.
inline constexpr double correction_cap = 0.2;

/// Restitution threshold in units of |gravity| * step * (1 - e): slower approaches do not bounce, so that
/// bodies come to rest. The bounces left out would be over within twice as many substeps as this number.
/// Larger: rest comes sooner.
inline constexpr double restitution_threshold = 2.0;
/// Restitution threshold of the accurate mode, where contacts at rest are solved well enough to stay under
/// it.
inline constexpr double accurate_restitution_threshold = 0.5;
/// Least value of 1 - e in the threshold for e < 1. It bounds the number of bounces of a body in one substep,
/// to half its inverse divided by the restitution threshold.
inline constexpr double least_loss = 0.02;

/// Further closing by the end of a substep (of the pair's smaller smallest_size) from which on an approach is
/// an impact at its own time, whatever the pair: normals at the midpoint are meaningless for bodies that have
/// passed through one another by then. Smaller: impacts where the response would be enough.
inline constexpr double deep_approach = 0.25;

/// Ratio of masses from which on a heavy body does not wait for its impacts with lighter ones, and these do
/// not wait for each other. Smaller: fewer rounds of impacts, but the change that one impact makes to the
/// heavy body affects the next impact only in the next round.
inline constexpr double heavy_ratio = 100;

/// Slowest approach that can count as an impact, relative to the bodies' speeds; below it the approach is
/// rounding.
inline constexpr double closing_speed = 1e-12;
/// Share of the approach's energy that an impact may gain by rounding before its impulses are scaled down.
inline constexpr double impact_gain = 1e-12;

/// Change of the impulses in one sweep, relative to their size, at which they have converged. Few contacts
/// are solved to the first value; a heap is solved to the second, and the rest is left to the next substeps.
/// response.tolerance replaces both. Larger: towers rock; heaps come to rest too dense.
inline constexpr double response_change = 1e-10;
inline constexpr double heap_change = 3e-3;
/// Largest such change for a heap that flows. Larger: its bodies overlap more; smaller: more sweeps, against
/// overlaps that the motion makes anew (docs/decisions/0052 lists the trade-off).
inline constexpr double heap_change_in_flow = 2e-2;
/// Mean overlaps of the contacts that overlap in a heap that flows, before the position correction (of the
/// smaller size): under the first, the change at which its sweeps end is doubled in the next substeps; over
/// the second, it is halved. Larger: fewer sweeps, and heaps that flow overlap more.
inline constexpr double little_overlap_in_flow = 5e-4;
inline constexpr double much_overlap_in_flow = 1e-3;
/// Residual power: the power of the normal impulses on the relative velocities that they leave, as a share of
/// the power of all impulses on all that they change. Over the first bound a heap is swept twice as often in
/// the next substeps, and under the second half as often. This power shows slow modes of many layers, which
/// the change in one sweep does not show. Smaller: heaps come to rest sooner, and cost more until then.
inline constexpr double residual_power = 0.01;
inline constexpr double done_power = 0.004;
/// Residual power under which a heap is swept half as often as the usual minimum, and then a third as often;
/// over the second bound it is no longer swept only a third as often.
inline constexpr double least_sweeps_power = 0.0004;
inline constexpr double stirring_power = 0.001;
/// Share of the dissipated power that is not counted as residual: a heap that flows leaves 0.01 to 0.08 of
/// it, slow modes leave 0.3 to 1. Larger: heaps come to rest later. Smaller: heaps in motion are swept more
/// often, which changes nothing in them.
inline constexpr double residual_of_dissipated = 0.1;
/// Dissipated power, as a share of the power of all impulses, over which the bodies of a heap, or of an
/// island that is solved on Host, move on one another: 0.5 to 1 where they flow, under 0.1 at rest.
inline constexpr double moving_power = 0.25;
/// Dissipated power, as a share of the power of all impulses, over which a heap flows as a whole, with 0.8 to
/// 2. Bodies that fall on others lose half of that power, and more by friction: boxes that rain on others
/// have 0.5 to 0.6, a deep heap that lands layer by layer 0.65 to 0.71. Larger: a heap that flows is swept
/// until nothing changes any more; smaller: deep heaps sink in while they land, and boxes that come to rest
/// bounce on the residual velocities.
inline constexpr double flowing_power = 0.75;
/// Residual power of one substep, as a share of the power of its impulses, over which the heap gets the most
/// sweeps at once, as when it has just fallen on its ground; where it flows, the share is 0.005 to 0.09.
/// Larger: deep heaps sink in while they land. Smaller: heaps that only move get the most sweeps as well.
inline constexpr double all_residual = 0.5;
/// Factor by which a residual must exceed its bound for the number of sweeps to rise to its maximum at once,
/// or by two degrees instead of one.
inline constexpr double much_residual = 4;
/// Least change at which sweeps with impulses in float end; the rounding of float is 1e-7.
inline constexpr double mixed_change = 2e-6;

/// Separating speed before gravity's kick up to which a contact is still held at 0, in units of |gravity| *
/// step. Smaller: the noise of resting faces becomes targets that no rigid body can meet at all points, and
/// solving them takes long. Larger: held contacts gain more energy, before their island is scaled down.
inline constexpr double separating_speed = 1e-5;

/// Sliding speed of a contact, as a share of that before the substep, under which the contact may have come
/// to stick. It is not 0: on a slope, the energy that sticking would gain is taken out of the impulses, which
/// leaves some sliding.
inline constexpr double sticking_slip = 0.1;
/// Share of a substep under which it is not cut where a contact comes to stick. The resulting error in the
/// position is that share of half the distance slid in the substep. Smaller: more substeps.
inline constexpr double least_cut = 1e-4;
/// Distance that a contact must slide in a substep to be more than at rest (of smallest_size); otherwise the
/// substep is not cut. Smaller: rounding causes cuts, too.
inline constexpr double least_slide = 1e-9;

/// Energy that the impulses of an island may gain before they are scaled down, as a share of half p.W p. Such
/// a gain is within the tolerance of the response.
inline constexpr double response_gain = 1e-10;
/// Such a share where impulses are found in float: the rounding of velocities may be thousands of times that
/// of the changes by impulses. Larger: gains of energy pass. Smaller: rounding is taken for a gain.
inline constexpr double mixed_response_gain = 1e-3;

/// Relative margin by which the closing speed of a contact in flight may grow before the contact counts as
/// touched.
inline constexpr double flight_margin = 1e-9;
/// Number of roundings of the bodies' speeds, in the precision of the impulses, that are added to that
/// margin.
inline constexpr double flight_roundings = 8;
/// Changes at which two iterations end: that for the time of an impact (of the substep), and that for the
/// impulses of one impact (of their size). Both are solved to rounding; energy depends on neither.
inline constexpr double impact_time = 1e-15;
inline constexpr double impact_residual = 1e-15;
/// Relative rounding of the distance of two balls, at which the time of their impact cannot be found better.
inline constexpr double impact_distance = 1e-14;
/// Distance below its level at which a search for a touch aims (of touching_gap). Larger: bodies at rest with
/// e = 1 bounce more; smaller: the search ends before the touch, and goes on.
inline constexpr double touch_aim = 0.0625;
/// Change of the impulses of an impact (of their size) under which a change that no longer falls is rounding
/// of the bodies' velocities.
inline constexpr double impact_rounding = 1e-10;

/// Gap at which bodies touch in the search for the time of an impact (of the smaller smallest_size): rounding
/// of positions. Smaller: the search may step through a contact. It must stay well under closed_gap.
inline constexpr double touching_gap = 1e-12;
/// Distance that this search may advance where the gap is nearly 0 and bodies separate or slide (of the
/// smaller smallest_size). Larger: a brief touch in between may be missed; smaller: more evaluations.
inline constexpr double search_advance = 0.1;

/// Rotation of a body in a flight (rad) from which on no conclusion about the flight is drawn from its ends.
inline constexpr double far_turn = 1.0;
/// Largest rotation of a free body in one step of the splitting (rad); a larger one is made in several steps.
/// Larger: less accurate, faster.
inline constexpr double split_turn = 0.5;
/// Rotation of a free body in one step (rad) under which its cube is rounding: the body is then turned about
/// its mean spin.
inline constexpr double hardly_a_turn = 5e-6;
static_assert(hardly_a_turn * hardly_a_turn * hardly_a_turn < std::numeric_limits<double>::epsilon());
/// Largest rotation that restores a body's energy after the splitting (rad); if more is needed, the splitting
/// has failed, and nothing is restored.
inline constexpr double energy_turn = 0.1;
/// Share of a body's energy under which its error is rounding and is not restored.
inline constexpr double energy_rounding = 4e-16;
/// Slope of the energy per radian of that rotation (of the energy) under which the body turns about a
/// principal axis and there is nothing to restore.
inline constexpr double energy_slope = 1e-8;

/// Share of the response's tolerance to which the direct solver goes on, so that the next substep starts from
/// a solution.
inline constexpr double direct_share = 0.01;

/// Difference from 1 under which a quaternion's length counts as 1, but for rounding. It must exceed the
/// error that normalising leaves, some 1e-16: then a state that was written is read back to the bit.
inline constexpr double unit_length = 1e-14;

/// Share of a step under which a shorter last step is only rounding of end / step, and is not taken.
inline constexpr double step_count = 1e-9;

static_assert(moving_power < flowing_power);
static_assert(little_overlap_in_flow < much_overlap_in_flow && much_overlap_in_flow <= 2 * mean_overlap_left);
static_assert(least_sweeps_power < stirring_power && stirring_power < done_power);
static_assert(done_power < residual_power);
static_assert(closed_gap < contact_slack);
static_assert(corrected_overlap < closed_gap);
static_assert(4 * coarser_overlap < substep_overlap);
static_assert(touching_gap < closed_gap);

// Narrow phase. Lengths are relative to the smaller smallest_size of the pair.

/// Relative rounding of a squared distance, by which two bodies must be farther apart than their margins
/// before their test is left out.
inline constexpr double far_rounding = 1e-12;

/// Distance of two sphere centres under which their direction is rounding noise (of the sum of the radii).
inline constexpr double coincident = 1e-14;

/// Cosine of the angle between the normal of a contact at an edge or a corner and that of a face, from which
/// on points over the face are added to the contact. Smaller: more such contacts have more points.
inline constexpr double over_face_cosine = 0.95;

/// Sine of the angle under which the cross product of two box edges is too short to be a separating axis. The
/// overlap along any axis is exact whatever the axis's rounding; a smaller value only adds axes that repeat
/// those of the faces.
inline constexpr double parallel_axes = 1e-6;
/// Sine of the angle under which two box edges in contact count as parallel: their closest points are then
/// badly placed, and faces carry the contact. It must exceed parallel_axes.
inline constexpr double parallel_edges = 1e-3;

/// Amount by which an axis must separate two boxes better than a preferred one to replace it: a share of the
/// preferred separation, plus a length. Faces are preferred to edges and the first body's to the second's, so
/// that noise in a resting stack does not change the manifold. Larger: steadier, but overlaps are
/// overestimated by as much. The length must exceed same_feature.
inline constexpr double axis_preference = 0.3;
inline constexpr double axis_preference_length = 1e-4;

/// Length under which two points of a box-box contact count as equally deep, and by which a vertex may be
/// beyond a face and still counts as over it: noise in aligned stacks then does not change the features.
inline constexpr double same_feature = 1e-6;

/// Amount by which the overlap along libccd's direction may exceed the least known overlap before the
/// direction is refused.
inline constexpr double libccd_excess = 1e-6;

/// Amount by which a unit normal may leave the normal cone of a mesh's edge or vertex: rounding, because of
/// which neither of two triangles might make the contact otherwise. A bend under this counts as flat.
inline constexpr double cone_slack = 1e-9;

/// Difference of a cosine from 1 under which a face is in contact as a whole, and not only its nearest edge
/// or vertex: 0.06 rad. Larger: points that are far from touching.
inline constexpr double face_cosine = 2e-3;

/// Relative change of a distance at which the search for it ends: a few roundings.
inline constexpr double distance_change = 1e-15;
/// Distance of two convex bodies under which they count as overlapping in that search (of the smaller
/// smallest_size). It must exceed the rounding of the search.
inline constexpr double overlapping = 1e-10;
static_assert(overlapping < closed_gap);

/// Distance from which on the nearest points of two cores give their direction to rounding (of the size).
inline constexpr double clear_gap = 1e-4;
static_assert(clear_gap > overlapping);
/// Distance to which overlapping bodies are moved apart to search for their nearest points (of the size);
/// small against their features.
inline constexpr double clear_distance = 0.05;
/// Overlap under which the climb from the best of the faces and edges leads to the best of all directions (of
/// the size).
inline constexpr double shallow_overlap = 1e-3;

/// Angle (rad) up to which two directions in a scene count as the same.
inline constexpr double same_direction = 1e-9;

/// Thickness of a triangle (of its longest extent) under which it counts as having no area, and distance from
/// a face under which a point counts as in it.
inline constexpr double flat = 1e-10;
/// Thickness of the points of a hull (of their longest extent) under which they count as plane. Coordinates
/// in single precision, or with six digits, do not distinguish thinner ones from a plane; hulls of a
/// millionth are kept.
inline constexpr double thin_hull = 2e-7;
/// Distance of two points of a hull, and of a point from a plane, that counts as none: coplanar times the
/// hull's longest extent, or times coplanar_thicknesses of its thickness if that is less. It must exceed the
/// noise of points in single precision, 1e-7, and should exceed that of six digits; otherwise a face falls
/// into several, and the body rests on one of them. Larger: facets of fine hulls are lost.
inline constexpr double coplanar = 1e-6;
inline constexpr double coplanar_thicknesses = 5;
/// Multiple of the distance that counts as none by which a point may be outside of a hull's face, or a corner
/// off its plane; beyond that, the points are stretched to a box and the hull is made again. How
/// far adversarial sets go is in decision 0040.
inline constexpr double most_off_face = 20;
// All corners of a face must touch at once: the smallest size is half the thickness.
static_assert(2 * coplanar * coplanar_thicknesses <= closed_gap);
/// Distance under which corners of a mesh count as one, and a corner as on an edge: the smaller of a share of
/// the mesh's size (the diagonal of its box) and a share of the shortest edge at the corners, so that corners
/// at both ends of an edge are not joined. The first share covers two copies of a corner that are each off
/// by 1e-5 of the size along every axis. Larger: slits and thin sheets close; smaller: cracks stay.
inline constexpr double weld_size = 4e-5;
inline constexpr double weld_edge = 1e-2;
/// Least value of that distance (of the mesh's size): shorter edges are rounding.
inline constexpr double weld_least = 1e-9;
static_assert(flat < weld_least && weld_least < weld_size);
/// Difference of two principal moments, and products of inertia, that count as rounding (of the largest
/// moment).
inline constexpr double equal_moments = 1e-12;

static_assert(parallel_axes < parallel_edges);
static_assert(same_feature < axis_preference_length);

}  // namespace scree::tolerance
