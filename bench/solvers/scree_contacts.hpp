// The contact store of scree's step on Host, filled with a captured problem.
#pragma once

#include "bench/solvers/problem.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/observe/inspection.hpp"
#include "sim/response/contact_inspection.hpp"
#include "sim/response/direct.hpp"
#include "sim/response/sweep_plan.hpp"

#include <cstdint>
#include <vector>

namespace scree::bench {

class ScreeContacts {
 public:
  explicit ScreeContacts(const ContactProblem& problem);

  /// Sets all impulses to zero.
  void reset();
  /// Sweeps from the present impulses. Returns false if they have not converged.
  bool sweep(const SweepPlan& plan);
  /// Solves the islands whose natural residual is beyond the tolerance. Returns false if one is left
  /// unsolved.
  bool solve_islands(double tolerance, const DirectLimits& limits, std::int64_t& solved,
                     std::int64_t& failed);

  std::int64_t contacts() const { return static_cast<std::int64_t>(problem_.contacts.size()); }
  std::int64_t points() const { return static_cast<std::int64_t>(problem_.points.size()); }
  /// Returns the impulse of each point, in the frame of its contact.
  PointVectors impulses();

 private:
  /// The place of a contact among the contacts of its kind.
  struct Place {
    bool balls;
    std::int64_t at;
  };

  std::vector<int> color_contacts(bool balls);
  bool is_of_balls(const ContactProblem::Contact& contact) const;
  void place_contacts();
  void fill_ball(const ContactProblem::Contact& contact, std::int64_t to);
  void fill_points(const ContactProblem::Contact& contact, std::int64_t to);
  SolverBody body(std::int32_t k) const;

  const ContactProblem& problem_;
  std::vector<Place> place_;  // place of each contact
  std::vector<solver::Slot> slots_;
  solver::ContactStore<Host, double> store_;
  std::int32_t padding_;
  Array<solver::BodyRecord<double>, Host> free_, solver_, last_;
};

}  // namespace scree::bench
