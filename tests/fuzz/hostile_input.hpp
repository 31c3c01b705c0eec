// Input of any bytes, and what may come of it: what it says, or an error of its own. Shared by the fuzzers,
// which make such bytes, and by the test that reads those which were kept.
#pragma once

#include <string_view>

namespace scree {

/// Reads the bytes as a scene. Lines that begin with `--set ` are no part of it, but overrides. Throws
/// std::logic_error if what came is neither an InputError with a place nor a scene in order: all of its
/// numbers finite, and its resolved text a scene that resolves to itself.
void read_hostile_scene(std::string_view bytes);

/// Reads the bytes as a body file, by itself and for a scene. Throws std::logic_error likewise.
void read_hostile_body_file(std::string_view bytes);

/// Reads the bytes as a mesh's file, and welds it. Throws std::logic_error if what came is neither an
/// InputError nor triangles in order: of finite places, each with an area, and edges that are counted.
void read_hostile_obj(std::string_view bytes);
void read_hostile_stl(std::string_view bytes);
void read_hostile_ply(std::string_view bytes);

/// Reads the bytes as points, of doubles if the first byte is even, or else of whole numbers and small parts
/// of one, which lie in a lattice or nearly. Throws std::logic_error if what came is neither an InputError
/// nor a hull in order that reaches as far as the points, but for a thousandth of its extent.
void read_hostile_points(std::string_view bytes);

/// Reads the bytes as what follows the first line of a checkpoint, which is given the right checksum: so that
/// it stops nobody. Throws std::logic_error if what came is neither a RunError nor a state of no more bytes
/// than the file, which is the same when it is written and read again.
void read_hostile_checkpoint(std::string_view bytes);

/// Reads the bytes as a trajectory: what it has of numbers, a line of `====`, and its index, which is given
/// the right checksum. Throws std::logic_error if what came is neither an InputError nor numbers of which
/// there are no more than bytes can hold.
void read_hostile_trajectory(std::string_view bytes);

/// Reads the bytes as two tables, parted by a line of `====`, and compares them. Throws std::logic_error if
/// what came is neither an InputError nor a comparison that is fair: the same from either side, and nothing
/// where a table is beside itself.
void read_hostile_tables(std::string_view bytes);

/// Reads the bytes as a manifest, for the run to be repeated, and for its number of steps. Throws
/// std::logic_error if what came is neither an InputError nor steps that there can be.
void read_hostile_manifest(std::string_view bytes);

}  // namespace scree
