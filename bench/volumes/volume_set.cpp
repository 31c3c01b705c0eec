#include "bench/volumes/volume_set.hpp"

#include "bench/volumes/box.hpp"
#include "bench/volumes/dop.hpp"
#include "bench/volumes/sphere.hpp"
#include "bench/volumes/swept_sphere.hpp"

#include <algorithm>
#include <iterator>

namespace scree::bench {

namespace {

template <class Fit>
class SetOf final : public VolumeSet {
 public:
  SetOf(const BodyTable& boxes, double margin) : bodies_(boxes) {
    for (const Vec3& half : boxes.size) fits_.emplace_back(half, margin * half.minCoeff());
    update();
  }

  const char* name() const override { return Fit::name; }
  std::int64_t size() const override { return std::ssize(volumes_); }
  std::size_t bytes() const override { return sizeof(Volume); }

  void update() override {
    volumes_.resize(fits_.size());
    for (std::size_t k = 0; k < fits_.size(); ++k)
      volumes_[k] = fits_[k].place(bodies_.position[k], bodies_.orientation[k]);
  }

  std::int64_t count(const std::vector<Pair>& pairs) const override {
    std::int64_t count = 0;
    for (const Pair& pair : pairs) count += meet(pair);
    return count;
  }

  std::vector<Pair> overlapping(const std::vector<Pair>& pairs) const override {
    std::vector<Pair> found;
    std::ranges::copy_if(pairs, std::back_inserter(found), [this](const Pair& pair) { return meet(pair); });
    return found;
  }

  std::vector<Aabb> boxes() const override {
    std::vector<Aabb> boxes;
    for (const Volume& volume : volumes_) boxes.push_back(box_of(volume));
    return boxes;
  }

  double tightness(std::int64_t sample) const override {
    double sum = 0;
    for (std::int64_t s = 0; s < sample; ++s) {
      const auto k = static_cast<std::size_t>(s);
      sum += volume_of(volumes_[k]) / scree::volume_of(Shape::box, bodies_.size[k]);
    }
    return sum / static_cast<double>(sample);
  }

 private:
  using Volume = decltype(std::declval<Fit>().place(Vec3(), Quat()));

  bool meet(const Pair& pair) const {
    return overlap(volumes_[static_cast<std::size_t>(pair.i)], volumes_[static_cast<std::size_t>(pair.j)]);
  }

  const BodyTable& bodies_;
  std::vector<Fit> fits_;
  std::vector<Volume> volumes_;
};

template <class... Fits>
std::vector<std::unique_ptr<VolumeSet>> sets_of(const BodyTable& boxes, double margin) {
  std::vector<std::unique_ptr<VolumeSet>> sets;
  (sets.push_back(std::make_unique<SetOf<Fits>>(boxes, margin)), ...);
  return sets;
}

}  // namespace

std::vector<std::unique_ptr<VolumeSet>> all_volume_sets(const BodyTable& boxes, double margin) {
  return sets_of<AabbFit, SphereFit, ObbFit, CapsuleFit, SweptRectangleFit, DopFit<8>, DopFit<14>>(boxes,
                                                                                                   margin);
}

}  // namespace scree::bench
