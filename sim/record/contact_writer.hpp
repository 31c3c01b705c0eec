// The contacts that carry a force, as they are written to contacts.vtkhdf: lines from body to body, which are
// the force chains of a packing.
#pragma once

#include "core/archive.hpp"
#include "core/snapshot.hpp"
#include "sim/observe/inspection.hpp"
#include "sim/record/frame_journal.hpp"
#include "sim/record/trajectory_reader.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace scree {

/// In the folder of a run.
inline constexpr const char* contacts_name = "contacts.vtkhdf";

/// Where the line of a contact ends at one of its bodies (m): at its centre, in a periodic space that of the
/// image that touches there, or at the contact if the body does not move, for the centre of a floor is
/// nowhere near.
Vec3 contact_end(const BodyTable& bodies, std::int32_t body, const Vec3& point);

/// What a contact takes in a frame, before it is made smaller (bytes).
double contact_bytes(const Scene& scene);

/// Two rows for each contact, one as each of its two bodies feels it; a line joins them. Columns: `position`
/// (m), where the line ends; `force` on the body (N); `point`, where it acts (m); `id` of the body, and
/// `other`, that of the one that it touches.
/// contact_forces() reads them again.
class ContactWriter {
 public:
  /// See FrameJournal.
  ContactWriter(const Scene& scene, std::filesystem::path file, AtomicFile::Opening opening, int threads);

  /// Adds a frame: the contacts of the last substep before the snapshot.
  void append(const Snapshot& snapshot, const std::vector<ContactForce>& contacts);
  void archive(Archive& archive) { journal_.archive(archive); }
  void finish() { journal_.finish(); }
  void drop() { journal_.drop(); }

 private:
  bool in_double_;
  FrameJournal journal_;
};

/// The contacts of a frame that ContactWriter has written, among bodies fewer than `bodies`. Throws
/// InputError if they cannot be read, or are of others.
std::vector<ContactForce> contact_forces(TrajectoryReader& contacts, std::size_t frame, std::int64_t bodies);

}  // namespace scree
