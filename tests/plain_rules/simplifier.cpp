#include "plain_rules/simplifier.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "plain_rules/connectivity.hpp"
#include "plain_rules/distance.hpp"
#include "plain_rules/edge_queue.hpp"
#include "plain_rules/riders.hpp"

namespace isoweave::plain {
namespace {

constexpr std::size_t kMostNeighbours = 24;

std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

struct Factors {
  float first, merged, back;
};

Factors factors_of(Quality quality) {
  if (quality == Quality::kFast) return {1, 1, 1};
  return quality == Quality::kNormal ? Factors{2, 1, 2} : Factors{2, 0.5F, 1.1F};
}

struct FaceSums {
  Quadric planes{};
  Vector normal{};
};

class Simplifier {
 public:
  Simplifier(const Surface& surface, const Options& options)
      : surface_(surface),
        options_(options),
        factors_(factors_of(options.quality)),
        memory_(options.normals_count ? 1 : 0.125),
        face_weight_(1 / (6 * surface.face * surface.face)),
        queue_(std::isinf(options.error) ? std::numeric_limits<float>::max()
                                         : cost_of(options.error * options.error / surface.face)),
        connectivity_(surface),
        quadrics_(surface.corners.size()),
        normal_quadrics_(surface.corners.size()) {
    if (options.most_distance > 0) extracted_.emplace(surface, options.most_distance);
  }

  Outcome run() {
    if (options_.error > 0) {
      lock_corners();
      for (std::size_t v = 0; v < locked_.size(); ++v) {
        if (connectivity_.uses(v) && !locked_[v]) give_quadric(v);
      }
      give_first_keys();
      while (!queue_.empty() && !(options_.triangles > 0 && connectivity_.left() <= options_.triangles)) {
        decide(queue_.first());
      }
    }
    return outcome();
  }

 private:
  const Vector& place(std::size_t v) const { return surface_.corners[v].place; }
  std::uint64_t id(std::size_t v) const { return surface_.corners[v].id; }

  void lock_corners() {
    locked_ = connectivity_.locked_corners();
    outcome_.locked = static_cast<std::uint64_t>(std::count(locked_.begin(), locked_.end(), true));
  }

  // As seen from v, twice as long as the area.
  Vector face_normal(std::size_t v, std::size_t a, std::size_t b) const {
    return cross(place(a) - place(v), place(b) - place(v));
  }

  // Of the planes of the faces around v that do not hold `without`.
  FaceSums sum_faces(std::size_t v, const Ring& ring, double weight, std::size_t without) const {
    FaceSums sums;
    for (std::size_t n = 0; n < ring.faces(); ++n) {
      if (ring.around[n] == without || ring.after(n) == without) continue;
      const Vector normal = face_normal(v, ring.around[n], ring.after(n));
      const double size = length(normal);
      if (size > 0) sums.planes = sums.planes + square(normal, 0, weight / size);
      sums.normal = sums.normal + normal;
    }
    return sums;
  }

  // Through the side from v to w, upright on the face over it, which has the corners v, a and b.
  Quadric side_plane(std::size_t v, std::size_t w, std::size_t a, std::size_t b) const {
    const Vector side = place(w) - place(v);
    const Vector across = cross(side, face_normal(v, a, b));
    const double squared = dot(across, across);
    if (!(squared > 0)) return {};
    return square(across, 0, dot(side, side) / (surface_.face * surface_.face * squared));
  }

  std::array<Quadric, 2> side_planes(std::size_t v, const Ring& ring) const {
    const auto& r = ring.around;
    return {side_plane(v, r[0], r[0], r[1]), side_plane(v, r.back(), r[r.size() - 2], r.back())};
  }

  void give_quadric(std::size_t v) {
    const Ring ring = connectivity_.ring_of(v);
    Quadric& q = quadrics_[v];
    q = sum_faces(v, ring, face_weight_, v).planes;
    if (ring.open) {
      const auto [first, last] = side_planes(v, ring);
      q = q + first + last;
    }
    for (std::size_t n = 0; n < ring.faces() && options_.normals_count; ++n)
      add_normals(v, ring.around[n], ring.after(n));
  }

  // Of a face around v, over which each component of the normal is a linear function.
  void add_normals(std::size_t v, std::size_t a, std::size_t b) {
    const Vector to_a = place(a) - place(v);
    const Vector to_b = place(b) - place(v);
    const Vector across = cross(to_a, to_b);
    const double squared = dot(across, across);
    if (!(std::sqrt(squared) > 0)) return;
    const double weight = face_weight_ * 0.25 * surface_.face * std::sqrt(squared);
    const Vector along_a = (1 / squared) * cross(to_b, across);
    const Vector along_b = (1 / squared) * cross(across, to_a);
    const auto normal = [&](std::size_t w, std::size_t c) { return double{surface_.corners[w].normal[c]}; };
    NormalQuadric& sum = normal_quadrics_[v];
    for (std::size_t c = 0; c < 3; ++c) {
      const double here = normal(v, c);
      const Vector gradient = (normal(a, c) - here) * along_a + (normal(b, c) - here) * along_b;
      quadrics_[v] = quadrics_[v] + square(gradient, here, weight);
      sum.gradient[c] = sum.gradient[c] + weight * gradient;
      sum.offset[c] = sum.offset[c] + weight * here;
    }
    sum.weight += weight;
  }

  // Of the two ends, from the one with the smaller id.
  Edge in_order(const Edge& edge) const {
    return id(edge.first) < id(edge.second) ? edge : Edge{edge.second, edge.first};
  }

  float quadric_cost(const Edge& edge) const {
    const auto [u, v] = in_order(edge);
    const Vector along = place(v) - place(u);
    const Quadric q = with_normals(quadrics_[u] + moved(quadrics_[v], -1.0 * along), u, v);
    return cost_of(evaluate(q, Solver(q).least(q, 0.5 * along)));
  }

  Quadric with_normals(const Quadric& q, std::size_t u, std::size_t v) const {
    if (!options_.normals_count) return q;
    return with_best_normal(q, normal_quadrics_[u] + moved(normal_quadrics_[v], place(u) - place(v)));
  }

  std::uint64_t tie_of(const Edge& edge) const {
    const auto [u, v] = in_order(edge);
    const std::uint64_t low = id(u);
    const std::uint64_t high = id(v);
    if (surface_.row == 0) return mix(low << 32 | high);
    const std::uint64_t step = high - low + 2 + 3 * (1 + surface_.row + surface_.plane);
    const std::uint64_t z = step / 3 / surface_.plane;
    const std::uint64_t y = step / 3 % surface_.plane / surface_.row;
    const std::uint64_t x = step / 3 % surface_.plane % surface_.row;
    return mix(256 * low + step % 3 + 3 * (x + 4 * y + 16 * z));
  }

  void give_first_keys() {
    for (const auto& corners : surface_.triangles) {
      for (std::size_t n = 0; n < 3; ++n) {
        const Edge edge = edge_between(corners[n], corners[(n + 1) % 3]);
        if (queue_.has(edge)) continue;
        const bool stays = locked_[edge.first] || locked_[edge.second];
        queue_.set(edge, {stays ? kNever : factors_.first * quadric_cost(edge), tie_of(edge)});
      }
    }
  }

  void postpone(const Edge& edge) {
    ++outcome_.postponed;
    queue_.raise(edge, std::max(16 * queue_.key(edge).first, 2.4e-4F));
  }

  void send_back(const Edge& edge, float cost) {
    ++outcome_.rekeyed;
    queue_.raise(edge, cost);
  }

  void decide(std::pair<Key, Edge> first) {
    const Edge edge = first.second;
    const float key = first.first.first;
    std::tie(u_, v_) = in_order(edge);
    u_ring_ = connectivity_.ring_of(u_, v_);
    v_ring_ = connectivity_.ring_of(v_, u_);
    if (options_.drop_specks && is_tetrahedron()) return decide_tetrahedron(edge, key);
    if (!topology_allows()) return postpone(edge);
    along_ = place(v_) - place(u_);
    const bool fast = options_.quality == Quality::kFast;
    Vector best{};
    const Quadric full = fast ? merged_quadric(best) : full_quadric(best);
    const float limit = fast ? key : factors_.back * key;
    const float cost = cost_of(evaluate(full, best));
    if (!fast && cost > limit) return send_back(edge, cost);
    Vector x{};
    if (!find_place(full, best, limit, x)) return postpone(edge);
    ++outcome_.collapses;
    note_cost(std::min(cost_of(evaluate(full, x)), key));
    collapse(edge, x);
    update_keys(key);
  }

  void note_cost(float cost) { dearest_ = std::max(dearest_, cost); }

  // What both ends remember, and where that is least.
  Quadric merged_quadric(Vector& best) const {
    const Quadric q = with_normals(quadrics_[u_] + moved(quadrics_[v_], -1.0 * along_), u_, v_);
    best = Solver(q).least(q, 0.5 * along_);
    return q;
  }

  // Memory and present faces, and where that is least among the places that keep the volume.
  Quadric full_quadric(Vector& best) const {
    const double weight = (2 - memory_) * face_weight_;
    const FaceSums u_faces = sum_faces(u_, u_ring_, weight, u_);
    const FaceSums v_faces = sum_faces(v_, v_ring_, weight, u_);
    const Quadric q = with_normals(
        end_quadric(u_, u_ring_, u_faces.planes) + moved(end_quadric(v_, v_ring_, v_faces.planes), -1.0 * along_), u_,
        v_);
    const Solver solver(q);
    best = solver.least(q, 0.5 * along_);
    const Vector gradient = u_faces.normal + v_faces.normal;
    const double offset = dot(v_faces.normal, along_);
    const Vector response = solver.solve(gradient);
    const double strength = dot(gradient, response);
    if (strength > 0) best = best + ((offset - dot(gradient, best)) / strength) * response;
    return q;
  }

  Quadric end_quadric(std::size_t v, const Ring& ring, const Quadric& faces) const {
    const Quadric sum = memory_ * quadrics_[v] + faces;
    if (!ring.open) return sum;
    const auto [first, last] = side_planes(v, ring);
    return sum + (2 - memory_) * (first + last);
  }

  bool is_border_edge() const {
    return u_ring_.open && v_ring_.open && (u_ring_.around[0] == v_ || v_ring_.around[0] == u_);
  }

  bool topology_allows() const {
    const bool border_edge = is_border_edge();
    if (u_ring_.open && v_ring_.open && !border_edge) return false;
    const std::size_t opposite = border_edge ? 1 : 2;
    if (u_ring_.around.size() + v_ring_.around.size() > kMostNeighbours + 2 + opposite) return false;
    const auto common =
        std::count_if(u_ring_.around.begin(), u_ring_.around.end(), [&](std::size_t w) { return v_ring_.has(w); });
    if (static_cast<std::size_t>(common) != opposite) return false;
    const bool alone = u_ring_.around.size() == opposite + 1 && v_ring_.around.size() == opposite + 1;
    return !(alone && u_ring_.open == v_ring_.open);
  }

  bool is_tetrahedron() const {
    if (u_ring_.open || v_ring_.open || u_ring_.around.size() != 3 || v_ring_.around.size() != 3) return false;
    return std::ranges::all_of(u_ring_.around, [&](std::size_t w) { return w == v_ || v_ring_.has(w); });
  }

  void decide_tetrahedron(const Edge& edge, float key) {
    std::set<std::size_t> corners{u_};
    corners.insert(u_ring_.around.begin(), u_ring_.around.end());
    double longest = 0;
    for (const std::size_t a : corners) {
      for (const std::size_t b : corners) longest = std::max(longest, dot(place(a) - place(b), place(a) - place(b)));
    }
    const float cost = cost_of(longest / (4 * surface_.face));
    if (cost > key) return send_back(edge, cost);
    ++outcome_.specks;
    note_cost(cost);
    for (const std::size_t end : {u_, v_}) connectivity_.remove_around(end);
    for (const std::size_t a : corners) {
      for (const std::size_t b : corners) queue_.forget(edge_between(a, b));
    }
  }

  // Whether all faces of an end that stay keep their side when it moves.
  bool keeps_sides(std::size_t v, const Ring& ring, std::size_t other, const Vector& move) const {
    for (std::size_t n = 0; n < ring.faces(); ++n) {
      const std::size_t a = ring.around[n];
      const std::size_t b = ring.after(n);
      if (a == other || b == other) continue;
      const Vector before = face_normal(v, a, b);
      const Vector after = cross(place(a) - place(v) - move, place(b) - place(v) - move);
      const double squared = dot(before, before);
      const double cosine = dot(before, after);
      if (squared > 0 && !(cosine > 0 && cosine * cosine > 0.2 * 0.2 * squared * dot(after, after))) return false;
    }
    return true;
  }

  bool allows(const Vector& x) {
    if (!keeps_sides(u_, u_ring_, v_, x) || !keeps_sides(v_, v_ring_, u_, x - along_)) return false;
    return !extracted_ || (stays_in_layers(place(u_) + x) && stays_near(place(u_) + x));
  }

  // Of the voxels that both stars lie in.
  bool stays_in_layers(const Vector& to) const {
    const double height = std::max(surface_.layer, options_.most_distance / 2);
    const auto layer = [&](double z) { return std::floor(z / height + 0.382); };
    double low = place(u_)[2];
    double high = low;
    for (const Ring* ring : {&u_ring_, &v_ring_}) {
      for (const std::size_t w : ring->around) {
        low = std::min(low, place(w)[2]);
        high = std::max(high, place(w)[2]);
      }
    }
    return layer(low) <= layer(to[2]) && layer(to[2]) <= layer(high);
  }

  // The corners of the faces that stay, besides the merged one.
  std::vector<std::array<std::size_t, 2>> staying() const {
    std::vector<std::array<std::size_t, 2>> faces;
    for (const Ring* ring : {&u_ring_, &v_ring_}) {
      const std::size_t gone = ring == &u_ring_ ? v_ : u_;
      for (std::size_t n = 0; n < ring->faces(); ++n) {
        if (ring->around[n] != gone && ring->after(n) != gone) faces.push_back({ring->around[n], ring->after(n)});
      }
    }
    return faces;
  }

  bool stays_near(const Vector& to) const {
    return std::ranges::all_of(staying(), [&](const std::array<std::size_t, 2>& face) {
      return extracted_->holds({to, place(face[0]), place(face[1])});
    });
  }

  // The best place, or else the cheapest of both ends and the middle that is allowed.
  bool find_place(const Quadric& q, const Vector& best, float limit, Vector& x) {
    x = best;
    if (allows(x)) return true;
    std::vector<std::pair<float, Vector>> places;
    for (const Vector& p : {Vector{}, along_, 0.5 * along_}) places.emplace_back(cost_of(evaluate(q, p)), p);
    std::ranges::stable_sort(places, {}, &std::pair<float, Vector>::first);
    for (const auto& [cost, p] : places) {
      if (cost > limit) return false;
      x = p;
      if (allows(x)) return true;
    }
    return false;
  }

  // Merges both ends into u.
  void collapse(const Edge& edge, const Vector& x) {
    queue_.forget(edge);
    for (const std::size_t w : v_ring_.around) {
      if (w == u_) continue;
      const Key key = queue_.key(edge_between(v_, w));
      queue_.forget(edge_between(v_, w));
      const Edge beside = edge_between(u_, w);
      if (!queue_.has(beside) || key < queue_.key(beside)) queue_.set(beside, key);
    }
    connectivity_.merge(v_, u_);
    quadrics_[u_] = moved(quadrics_[u_], x) + moved(quadrics_[v_], x - along_);
    merge_riders(x);
    surface_.corners[u_].place = place(u_) + x;
  }

  void merge_riders(const Vector& x) {
    Corner& merged = surface_.corners[u_];
    const Corner& gone = surface_.corners[v_];
    if (options_.normals_count) {
      normal_quadrics_[u_] = moved(normal_quadrics_[u_], x) + moved(normal_quadrics_[v_], x - along_);
      merged.normal = unit_normal(normal_quadrics_[u_].offset);
    } else {
      for (std::size_t c = 0; c < 3; ++c) merged.normal[c] += gone.normal[c];
    }
    const double squared = dot(along_, along_);
    const double t = squared > 0 ? std::clamp(dot(x, along_) / squared, 0.0, 1.0) : 0.5;
    merged.value = static_cast<float>(value_between(double{merged.value}, double{gone.value}, t));
  }

  // Those around the merged corner.
  void update_keys(float collapsed_at) {
    const Ring ring = connectivity_.ring_of(u_);
    for (const std::size_t w : ring.around) {
      const Edge edge = edge_between(u_, w);
      const float before = queue_.key(edge).first;
      if (before > queue_.retire()) continue;
      queue_.raise(edge, std::max({before, step_above(collapsed_at), factors_.merged * quadric_cost(edge)}));
    }
  }

  Outcome outcome() {
    outcome_.dearest = dearest_ > kLeastCost ? std::sqrt(surface_.face) * std::sqrt(double{dearest_}) : 0;
    outcome_.surface.triangles = connectivity_.triangles();
    outcome_.surface.corners = std::move(surface_.corners);
    return std::move(outcome_);
  }

  Surface surface_;
  const Options options_;
  const Factors factors_;
  const double memory_;
  const double face_weight_;
  EdgeQueue queue_;
  Connectivity connectivity_;
  std::vector<bool> locked_;
  std::vector<Quadric> quadrics_;
  std::vector<NormalQuadric> normal_quadrics_;
  std::optional<Distances> extracted_;
  std::size_t u_ = 0, v_ = 0;  // the ends of the edge in question, that with the smaller id first
  Ring u_ring_, v_ring_;       // an open one begins at its border, a closed one at the other end
  Vector along_{};             // from u to v
  float dearest_ = 0;
  Outcome outcome_;
};

}  // namespace

Outcome simplify(const Surface& surface, const Options& options) { return Simplifier(surface, options).run(); }

}  // namespace isoweave::plain
