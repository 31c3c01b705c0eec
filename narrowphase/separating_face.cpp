#include "narrowphase/separating_face.hpp"

#include "narrowphase/convex_body.hpp"

namespace scree::detail {

SeparatingFace find_general_separating_face(const Instants<ShapedSolid>& i, const Instants<ShapedSolid>& j,
                                            const PairShapes& shapes, double slack, const Vec3& crossing) {
  const Vec3 origin = i.begin.solid.position;
  const auto placed = [&origin](const Instants<ShapedSolid>& body, const ShapeData* data) {
    return Instants<ConvexBody>{
        {body.begin, data, origin}, {body.seen, data, origin}, {body.end, data, origin}};
  };
  return best_face(placed(i, shapes.a), placed(j, shapes.b), slack, crossing);
}

}  // namespace scree::detail
