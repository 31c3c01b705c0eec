// Readers of hostile input, which may be any bytes: each must give what the bytes say, or its own kind of
// error. They are shared by the fuzzers, which make such bytes, and by the test that reads the kept corpus.
#pragma once

#include <string_view>

namespace scree {

/// Reads the bytes as a scene. Lines that begin with `--set ` are overrides and do not belong to its text.
/// Throws std::logic_error if the result is neither an InputError with a place nor a valid scene: one whose
/// numbers are all finite, and whose resolved text is a scene that resolves to itself.
void read_hostile_scene(std::string_view bytes);

/// Reads the bytes as a body file, by itself and as part of scenes. Throws std::logic_error if the result is
/// neither an InputError with a place nor valid rows, as many as the file counts, and a scene as above.
void read_hostile_body_file(std::string_view bytes);

/// These three read the bytes as a mesh file and weld the mesh. They throw std::logic_error if the result is
/// neither an InputError nor valid triangles: with finite positions, an area each, and known surroundings.
void read_hostile_obj(std::string_view bytes);
void read_hostile_stl(std::string_view bytes);
void read_hostile_ply(std::string_view bytes);

/// Reads the bytes as points and makes their hull. If the first byte is even, coordinates are doubles; if
/// odd, they are whole numbers plus small fractions, so that the points are nearly in a lattice. Throws
/// std::logic_error if the result is neither an InputError nor a valid hull that reaches as far as the
/// points, within a thousandth of its extent.
void read_hostile_points(std::string_view bytes);

/// Reads the bytes as the part of a checkpoint after its first line. The first line is made with the right
/// checksum, so that the checksum refuses no input. Throws std::logic_error if the result is neither a
/// RunError nor a state that has no more bytes than the file and is the same when it is written and read
/// again.
void read_hostile_checkpoint(std::string_view bytes);

/// Reads the bytes as a trajectory: its numbers, a line `====`, and its index, to which the right checksum is
/// added. Throws std::logic_error if the result is neither an InputError nor as many numbers as the index
/// says and the bytes can hold.
void read_hostile_trajectory(std::string_view bytes);

/// Reads the bytes as two tables, separated by a line `====`, and compares them. Throws std::logic_error if
/// the result is neither an InputError nor a fair comparison: one that is the same in both orders, and that
/// finds no difference between a table and itself.
void read_hostile_tables(std::string_view bytes);

/// Reads the bytes as a manifest, once to repeat its run and once for its number of steps. Throws
/// std::logic_error if the result is neither an InputError nor possible steps: none is negative, and both
/// readings agree.
void read_hostile_manifest(std::string_view bytes);

}  // namespace scree
