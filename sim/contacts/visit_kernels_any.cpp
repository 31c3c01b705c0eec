// The choice of kernels on processors for which scree has no kernels of their own: always the baseline.
#include "sim/contacts/visit_kernels.hpp"

namespace scree::solver {

const ContactKernels& contact_kernels(const char*) { return baseline::contact_kernels; }

}  // namespace scree::solver
