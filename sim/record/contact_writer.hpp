// The writer of contacts.vtkhdf: the contacts that carry a force, as lines from body to body, which are the
// force chains of a packing.
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

/// The name of the file in the folder of a run.
inline constexpr const char* contacts_name = "contacts.vtkhdf";

/// Returns the point at which the line of a contact ends at one of its bodies (m). It is the centre of the
/// body, in a periodic space that of the image that touches there. If the body does not move it is the
/// contact point, since the centre of a floor may be far away.
Vec3 contact_end(const BodyTable& bodies, std::int32_t body, const Vec3& point);

/// Returns the number of bytes of a contact in a frame, before compression.
double contact_bytes(const Scene& scene);

/// The writer of a frame's contacts. A contact has two rows, one for each of its two bodies; a line joins
/// them. The columns are `position` (m), the end of the line; `force` on the body (N); `point`, at which the
/// force acts (m); `id` of the body, and `other`, the id of the body that it touches. contact_forces() reads
/// them again.
class ContactWriter {
 public:
  /// The parameters are those of FrameJournal.
  ContactWriter(const Scene& scene, std::filesystem::path file, AtomicFile::Opening opening, int threads);

  /// Adds a frame of the contacts of the last substep before the snapshot.
  void append(const Snapshot& snapshot, const std::vector<ContactForce>& contacts);
  void archive(Archive& archive) { journal_.archive(archive); }
  void finish() { journal_.finish(); }
  void drop() { journal_.drop(); }

 private:
  bool in_double_;
  FrameJournal journal_;
};

/// Returns the contacts of a frame that ContactWriter has written. `bodies` is the number of bodies of the
/// scene. Throws InputError if the contacts cannot be read, or if they are those of other bodies.
std::vector<ContactForce> contact_forces(TrajectoryReader& contacts, std::size_t frame, std::int64_t bodies);

}  // namespace scree
