#include "snowshed/sampling/sample_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>

#include "snowshed/particles/point_grid.hpp"

namespace snowshed::sampling {
namespace {

/// The weight of a pair of points: (1 - d / (2 r_max))^8 as a fixed-point number, with their
/// distance d clamped to at least 2 r_min (Yuksel, equations 1, 5 and 6).
class PairWeight {
 public:
  PairWeight(int dimension, double point_measure, double sampled_share) {
    const double r_max = dimension == 2 ? std::sqrt(point_measure / (2 * std::sqrt(3.0)))
                                        : std::cbrt(point_measure / (4 * std::sqrt(2.0)));
    reach_ = 2 * r_max;
    per_reach_ = 1 / reach_;
    nearest_ = reach_ * 0.65 * (1 - sampled_share * std::sqrt(sampled_share));
  }

  double reach() const { return reach_; }

  std::int64_t operator()(const Vec3& a, const Vec3& b) const {
    const double squared = (a - b).squaredNorm();
    if (squared >= reach_ * reach_) return 0;
    const double w = 1 - std::max(std::sqrt(squared), nearest_) * per_reach_;
    const double w2 = w * w, w4 = w2 * w2;
    return static_cast<std::int64_t>(w4 * w4 * 0x1p40);
  }

 private:
  double reach_, per_reach_, nearest_;
};

/// A queue of points, the largest weight first. Weights only fall, so an entry of the queue is an
/// upper bound of its point's weight. It is corrected when it comes to the front.
class WeightQueue {
 public:
  explicit WeightQueue(std::vector<std::int64_t> weights) : weights_(std::move(weights)) {
    std::vector<Entry> entries(weights_.size());
    for (std::uint32_t i = 0; i < entries.size(); ++i) entries[i] = {weights_[i], i};
    queue_ = Queue(std::less<Entry>(), std::move(entries));
  }

  /// Removes the point with the largest weight and returns it.
  std::uint32_t pop() {
    for (;;) {
      const auto [weight, point] = queue_.top();
      queue_.pop();
      if (weight == weights_[point]) {
        weights_[point] = removed;
        return point;
      }
      queue_.push({weights_[point], point});
    }
  }

  bool contains(std::uint32_t point) const { return weights_[point] != removed; }

  /// Lowers the weight of a point that the queue contains.
  void lower(std::uint32_t point, std::int64_t by) { weights_[point] -= by; }

 private:
  using Entry = std::pair<std::int64_t, std::uint32_t>;
  using Queue = std::priority_queue<Entry>;
  static constexpr std::int64_t removed = -1;

  std::vector<std::int64_t> weights_;
  Queue queue_;
};

}  // namespace

std::vector<Vec3> eliminate_samples(const Candidates& candidates, std::size_t count, int dimension,
                                    double point_measure, const StopRequest& stop) {
  StopCheck check_stop(stop);
  const std::vector<Vec3>& points = candidates.points;
  const double sampled_share = static_cast<double>(count) / candidates.inside_count;
  const PairWeight pair_weight(dimension, point_measure, sampled_share);
  const particles::PointGrid grid(points, pair_weight.reach(), stop);

  std::vector<std::int64_t> weights(points.size(), 0);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    check_stop();
    grid.for_each_near(points[i], [&](std::uint32_t j, const Vec3& other) {
      if (j != i) weights[i] += pair_weight(points[i], other);
    });
  }

  WeightQueue queue(std::move(weights));
  for (std::size_t left = candidates.inside_count; left > count;) {
    check_stop();
    const std::uint32_t i = queue.pop();
    left -= candidates.inside[i];
    grid.for_each_near(points[i], [&](std::uint32_t j, const Vec3& other) {
      if (queue.contains(j)) queue.lower(j, pair_weight(points[i], other));
    });
  }

  std::vector<Vec3> chosen;
  chosen.reserve(count);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (candidates.inside[i] && queue.contains(i)) chosen.push_back(points[i]);
  return chosen;
}

}  // namespace snowshed::sampling
