// The keys of methods: how contacts are found and solved, and which features are modelled.
#include "sim/scene/key_sections.hpp"

namespace scree {
namespace {

/// Makes the codec of a number of grid levels, where 0 stands for auto.
Codec<int> levels() {
  const Codec<int> count = integer(between(1, 32));
  return any_of<int>({word<int>({{"auto", 0}}), count});
}

Codec<BroadPhaseMethod> broadphase_word() {
  using enum BroadPhaseMethod;
  return word<BroadPhaseMethod>({{"hierarchical_grid", hierarchical_grid},
                                 {"alternative_grid", alternative_grid},
                                 {"uniform_grid", uniform_grid},
                                 {"sweep_and_prune", sweep_and_prune},
                                 {"lbvh", lbvh},
                                 {"brute_force", brute_force}});
}

Codec<BoxBoxMethod> box_box_word() {
  using enum BoxBoxMethod;
  return word<BoxBoxMethod>({{"auto", automatic}, {"sat", sat}, {"ccd_gjk", ccd_gjk}, {"ccd_mpr", ccd_mpr}});
}

/// Makes the codec of the method for convex shapes. `auto` is left out of the resolved scene, as in scenes
/// that were written before there was a choice.
Codec<ConvexMethod> convex_word() {
  using enum ConvexMethod;
  Codec<ConvexMethod> codec =
      word<ConvexMethod>({{"auto", automatic}, {"axes", axes}, {"ccd_gjk", ccd_gjk}, {"ccd_mpr", ccd_mpr}});
  codec.write = [write = codec.write](const ConvexMethod& method) -> std::optional<Node> {
    return method == automatic ? std::nullopt : write(method);
  };
  return codec;
}

/// Makes the codec of the quality. The default, 1, is left out of the resolved scene, as in scenes that were
/// written before there was a choice.
Codec<double> quality_number() {
  Codec<double> codec = number(between(0.01, 100));
  codec.write = [write = codec.write](const double& quality) -> std::optional<Node> {
    return quality == 1 ? std::nullopt : write(quality);
  };
  return codec;
}

}  // namespace

Codec<ResponseSettings> response_section() {
  using T = ResponseSettings;
  return section<T>(
      "response", "How contact impulses are computed.",
      {
          key<T>(
              "mode", &T::mode,
              word<ResponseMode>({{"default", ResponseMode::standard}, {"accurate", ResponseMode::accurate}}),
              optionally,
              "accurate: contacts are solved until their natural residual is within the tolerance, free "
              "rotation is of fourth order, and slower approaches bounce; takes longer"),
          with_default(
              key<T>(
                  "quality", &T::quality, quality_number(), optionally,
                  "errors are smaller the larger it is. With 1, a step of many bodies in motion takes 1 to 4 "
                  "substeps, as few as leave overlaps of 5e-4 of the smaller body in the mean and 2e-2 at "
                  "worst. What moves faster leaves more. With q, these overlaps are divided by q, and so are "
                  "the changes at which sweeps and position correction of heaps end. Overlaps fall with the "
                  "square of the step's length: 4 allows twice as many substeps, 0.25 half as many"),
              "1"),
          key<T>("iterations", &T::iterations, or_auto(integer(between(1, 1e6))), optionally,
                 "largest number of sweeps over the contacts per substep; auto: 60, and more if there are "
                 "few contacts"),
          key<T>("block_sweeps", &T::block_sweeps, or_auto(integer(between(1, 100))), optionally,
                 "sweeps over the points that two bodies share, at each visit; auto: 4, with which stacks "
                 "stand still, but 1 for heaps"),
          key<T>("tolerance", &T::tolerance, or_auto(number(inside(0, 1))), optionally,
                 "sweeps stop when they change the impulses by less than this share. auto: 1e-10. For heaps "
                 "it is 3e-3 (up to 2e-2 where they flow), after at least 6 sweeps, or 12 where bodies share "
                 "several points; the rest is left to the next steps"),
          key<T>("warm_start", &T::warm_start, boolean(), optionally, "start from the last step's impulses"),
          key<T>("restitution_threshold", &T::restitution_threshold, or_auto(number(not_negative, "m/s")),
                 optionally, "slower approaches do not bounce; auto: 2 gravity step (1 - e)"),
      });
}

Codec<BroadPhaseSettings> broadphase_section() {
  using T = BroadPhaseSettings;
  return section<T>(
      "broadphase", "How the potentially colliding pairs are found. Never changes which they are.",
      {
          key<T>("method", &T::method, broadphase_word(), optionally, "the method"),
          key<T>("levels", &T::levels, levels(), optionally, "grid levels; auto: from the bodies' sizes"),
      });
}

Codec<NarrowPhaseSettings> narrowphase_section() {
  using T = NarrowPhaseSettings;
  return section<T>(
      "narrowphase", "How contact points are found.",
      {
          key<T>("box_box", &T::box_box, box_box_word(), optionally,
                 "for pairs of boxes; auto: the measured best"),
          with_default(key<T>("convex", &T::convex, convex_word(), optionally,
                              "for pairs of capsules, cylinders and polyhedra, with each other "
                              "and with spheres and boxes; auto: the measured best"),
                       "auto"),
          key<T>("crosscheck", &T::crosscheck, number(between(0, 1)), optionally,
                 "share of the pairs for which there is such a choice, chosen anew each substep, "
                 "that libccd is asked about too; where it differs is counted in the manifest"),
      });
}

Codec<ModelSettings> model_section() {
  using T = ModelSettings;
  const auto on_or_off = word<bool>({{"on", true}, {"off", false}, {"true", true}, {"false", false}});
  const auto feature = or_auto(on_or_off);
  const Codec<T> automatic{word_type({"auto"}), [](T& model, const Node&, Reader&) { model = {}; },
                           [](const T& model) -> std::optional<Node> {
                             const bool given = model.rotation || model.friction || model.rolling_friction ||
                                                model.restitution || model.continuous;
                             return given ? std::nullopt : std::optional(Node::scalar("auto"));
                           }};
  return any_of<T>(
      {automatic,
       section<T>("model", "Features to compute; auto: only if the scene needs them.",
                  {
                      key<T>("rotation", &T::rotation, feature, optionally,
                             "free bodies turn; off: they keep their orientation, and friction slides"),
                      key<T>("friction", &T::friction, feature, optionally, "contacts have friction"),
                      with_default(key<T>("rolling_friction", &T::rolling_friction, optional(on_or_off),
                                          optionally, "contacts resist rolling"),
                                   "auto"),
                      key<T>("restitution", &T::restitution, feature, optionally, "impacts bounce"),
                      key<T>("continuous", &T::continuous, feature, optionally,
                             "continuous collision detection: fast bodies meet at their own time inside a "
                             "step; auto: where they could pass through one another, or nearly"),
                  })});
}

}  // namespace scree
