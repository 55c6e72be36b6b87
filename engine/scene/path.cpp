// SPDX-License-Identifier: MIT
#include "engine/scene/path.h"

#include "engine/core/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

namespace shutter::scene {

using math::dmat3;
using math::dquat;
using math::dvec3;
using math::dvec4;

namespace {

bool isFinite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Value>
Value interpolate(
    const PathMotion& path, const KeyPlace& place, const std::function<Value(size_t)>& valueAt
) {
    return interpolateAtPlace<Value>(path.keys, path.interpolation, place, valueAt);
}

dvec4 toVector(const dquat& q) {
    return {q.x, q.y, q.z, q.w};
}

dquat toRotation(const dvec4& v) {
    return glm::normalize(dquat(v.w, v.x, v.y, v.z));
}

/// A key's rotation as seen from key `from`: of a rotation's two signs the one nearer to that of
/// the key before it on the way, so that the curve takes the shorter turns.
dvec4 alignRotation(const std::vector<PathKey>& keys, size_t from, size_t key) {
    dvec4 value = toVector(*keys[from].rotation);
    for (size_t at = from; at != key;) {
        at = key > at ? at + 1 : at - 1;
        const dvec4 next = toVector(*keys[at].rotation);
        value = glm::dot(value, next) < 0.0 ? -next : next;
    }
    return value;
}

dquat sampleRotation(const PathMotion& path, const KeyPlace& place) {
    const std::vector<PathKey>& keys = path.keys;
    if (path.interpolation == PathInterpolation::Linear && place.share > 0.0) {
        const dquat from = *keys[place.key].rotation;
        const dquat to = *keys[place.key + 1].rotation;
        if (to == from || to == -from) // a hold, to the bit
            return glm::normalize(from);
        return glm::slerp(glm::normalize(from), glm::normalize(to), place.share);
    }
    return toRotation(interpolate<dvec4>(path, place, [&](size_t key) {
        return alignRotation(keys, place.key, key);
    }));
}

// Orientation of a path with targets, straight down and up included.

/// Directions closer than this to `up`, sine of the angle, have no defined upright.
constexpr double kMinSine = 1.0e-6;
constexpr int kBisections = 60;

dvec3 normalizeOrZero(const dvec3& v) {
    const double size = glm::length(v);
    return size > 0.0 ? v / size : dvec3(0.0);
}

/// What of a direction is not along `up`.
dvec3 flatten(const dvec3& v, const dvec3& up) {
    return v - up * glm::dot(v, up);
}

bool isUpright(const dvec3& direction, const dvec3& up) {
    return glm::length(glm::cross(up, direction)) > kMinSine * glm::length(direction);
}

/// The direction of a view and its heading over the ground; unit vectors, or 0: unknown.
struct ViewDirection {
    dvec3 direction{0.0};
    dvec3 heading{0.0}; ///< at right angles to `up`

    [[nodiscard]] bool isWhole() const { return direction != dvec3(0.0) && heading != dvec3(0.0); }

    /// Fills its unknown vectors from another.
    void fill(const ViewDirection& other) {
        if (direction == dvec3(0.0))
            direction = other.direction;
        if (heading == dvec3(0.0))
            heading = other.heading;
    }
};

/// Axes of a view; +Y as near to `up` as they can.
dmat3 makeAxes(const ViewDirection& view, const dvec3& up) {
    const dvec3 back = -view.direction;
    const dvec3 right = glm::normalize(glm::cross(up, -view.heading));
    return {right, glm::cross(back, right), back};
}

/// Anticlockwise about the view's own axis.
dmat3 roll(const dmat3& axes, double radians) {
    const double c = std::cos(radians);
    const double s = std::sin(radians);
    return {axes[0] * c + axes[1] * s, axes[1] * c - axes[0] * s, axes[2]};
}

/// The direction to the target between two keys, a polynomial of the share of the span.
class Span {
  public:
    Span(const PathMotion& path, const KeyShot& shot, size_t key, const dvec3& up) : mUp(up) {
        const auto toTarget = [&](size_t i) { return *path.keys[i].lookAt; };
        const auto toPlace = [&](size_t i) { return path.keys[i].position; };
        const auto target = describeSpan<dvec3>(path.keys, path.interpolation, shot, key, toTarget);
        const auto place = describeSpan<dvec3>(path.keys, path.interpolation, shot, key, toPlace);
        const dvec3 from = target.from - place.from;
        const dvec3 to = target.to - place.to;
        const dvec3 out = target.outTangent - place.outTangent;
        const dvec3 in = target.inTangent - place.inTangent;
        mTerms = {from, out, 3.0 * (to - from) - 2.0 * out - in, 2.0 * (from - to) + out + in};
        for (const dvec3& term : mTerms)
            mSize = std::max(mSize, glm::length(term));
        mAcross = findAcross();
    }

    [[nodiscard]] dvec3 at(double x) const {
        return mTerms[0] + x * (mTerms[1] + x * (mTerms[2] + x * mTerms[3]));
    }

    /// \param sign -1: how it comes to x, 1: how it leaves
    [[nodiscard]] ViewDirection approach(double x, double sign) const {
        const std::array<dvec3, 4> terms = {
            at(x),
            sign * (mTerms[1] + x * (2.0 * mTerms[2] + 3.0 * x * mTerms[3])),
            mTerms[2] + 3.0 * x * mTerms[3],
            sign * mTerms[3]};
        ViewDirection view;
        for (const dvec3& term : terms) {
            const dvec3 flat = flatten(term, mUp);
            view.fill(
                {isAny(term) ? glm::normalize(term) : dvec3(0.0),
                 isAny(flat) && isUpright(term, mUp) ? glm::normalize(flat) : dvec3(0.0)}
            );
        }
        return view;
    }

    /// Straight down or up there, and not at itself.
    [[nodiscard]] bool isVertical(double x) const { return isAny(at(x)) && !isUpright(at(x), mUp); }

    /// Where it goes straight through `up` or down, in (0, 1), in rising order.
    [[nodiscard]] std::vector<double> findCrossings() const {
        std::vector<double> crossings;
        if (mAcross == dvec3(0.0))
            return crossings;
        std::optional<double> last; // where it is on one side or the other
        for (const double x : listTurns()) {
            if (!isUpright(at(x), mUp))
                continue;
            if (last && sideAt(*last) * sideAt(x) < 0.0)
                if (const double crossing = bisect(*last, x); isVertical(crossing))
                    crossings.push_back(crossing);
            last = x;
        }
        return crossings;
    }

  private:
    [[nodiscard]] bool isAny(const dvec3& term) const {
        return glm::length(term) > kMinSine * mSize;
    }

    /// The direction over the ground in which it goes most; 0: it stays on a vertical line.
    [[nodiscard]] dvec3 findAcross() const {
        dvec3 across(0.0);
        for (const dvec3& term : mTerms) {
            const dvec3 flat = flatten(term, mUp);
            if (isAny(flat) && glm::length(flat) > glm::length(across))
                across = flat;
        }
        return normalizeOrZero(across);
    }

    [[nodiscard]] double sideAt(double x) const { return glm::dot(at(x), mAcross); }

    /// 0, 1, and between them the places where sideAt() turns back.
    [[nodiscard]] std::vector<double> listTurns() const {
        const double a = 3.0 * glm::dot(mTerms[3], mAcross);
        const double b = 2.0 * glm::dot(mTerms[2], mAcross);
        const double c = glm::dot(mTerms[1], mAcross);
        std::vector<double> turns = {0.0};
        const double q =
            -0.5 * (b + std::copysign(std::sqrt(std::max(b * b - 4.0 * a * c, 0.0)), b));
        for (const double turn : {q / a, c / q})
            if (turn > 0.0 && turn < 1.0) // not NaN either
                turns.push_back(turn);
        turns.push_back(1.0);
        std::sort(turns.begin(), turns.end());
        return turns;
    }

    /// \param low, high on different sides
    [[nodiscard]] double bisect(double low, double high) const {
        const double side = sideAt(low);
        for (int i = 0; i < kBisections; ++i) {
            const double middle = 0.5 * (low + high);
            (sideAt(middle) * side > 0.0 ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    dvec3 mUp;
    std::array<dvec3, 4> mTerms{}; ///< of 1, x, x^2, x^3
    double mSize = 0.0;            ///< of the largest term
    dvec3 mAcross{0.0};
};

/// The view directions of one path in one shot.
class ViewDirections {
  public:
    ViewDirections(const PathMotion& path, const KeyShot& shot)
        : mPath(path), mShot(shot), mUp(glm::normalize(path.up)) {}

    [[nodiscard]] const dvec3& up() const { return mUp; }

    [[nodiscard]] Span span(size_t key) const { return {mPath, mShot, key, mUp}; }

    /// On arrival at a key; a static path uses the direction before it.
    [[nodiscard]] ViewDirection before(size_t key) const {
        ViewDirection view;
        for (size_t i = key; i > mShot.first && !view.isWhole(); --i)
            view.fill(span(i - 1).approach(1.0, -1.0));
        return view;
    }

    /// As it leaves a key.
    [[nodiscard]] ViewDirection after(size_t key) const {
        ViewDirection view;
        for (size_t i = key; i < mShot.last && !view.isWhole(); ++i)
            view.fill(span(i).approach(0.0, 1.0));
        return view;
    }

    /// Roll by which a path that leaves its key otherwise than it came is as it came.
    [[nodiscard]] double turnAt(size_t key, const Span& next) const {
        if (key == mShot.first || !next.isVertical(0.0))
            return 0.0;
        const ViewDirection came = before(key);
        const ViewDirection leaves = next.approach(0.0, 1.0);
        if (!came.isWhole() || !leaves.isWhole())
            return 0.0;
        const dmat3 from = makeAxes(leaves, mUp);
        const dvec3 right = makeAxes(came, mUp)[0];
        return std::atan2(glm::dot(right, from[1]), glm::dot(right, from[0]));
    }

  private:
    const PathMotion& mPath;
    KeyShot mShot;
    dvec3 mUp;
};

double ease(double share) {
    const double x = std::clamp(share, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

/// Roll on the way from a key to the next.
/// \param isOn `place` is on a crossing, or so near that it counts as before it
double findRoll(const ViewDirections& views, const Span& span, const KeyPlace& place, bool isOn) {
    double from = 0.0; // of the way
    double radians = views.turnAt(place.key, span);
    const auto at = [&](double x) { return radians * (1.0 - ease((x - from) / (1.0 - from))); };
    for (const double crossing : span.findCrossings()) {
        if (!(crossing < place.share) ||
            (isOn && span.isVertical(std::midpoint(crossing, place.share))))
            break;
        const double rolled = at(crossing);
        radians = rolled > 0.0 ? rolled - std::numbers::pi : rolled + std::numbers::pi;
        from = crossing;
    }
    return radians == 0.0 ? 0.0 : at(place.share);
}

/// Completes a view whose `direction` does not determine its roll.
ViewDirection
completeView(const ViewDirections& views, const KeyPlace& place, const dvec3& direction) {
    ViewDirection view{normalizeOrZero(direction), dvec3(0.0)};
    if (place.share > 0.0)
        view.fill(views.span(place.key).approach(place.share, -1.0));
    if (!view.isWhole())
        view.fill(views.before(place.key));
    if (!view.isWhole())
        view.fill(views.after(place.key));
    if (view.direction == dvec3(0.0))
        return view;
    if (isUpright(view.direction, views.up()))
        view.heading = flatten(view.direction, views.up());
    if (view.heading == dvec3(0.0)) {
        // Up is the axis farthest from `up`: a downward view then has its heading ahead, and the
        // reverse.
        const dvec3 other =
            std::abs(view.direction.z) < 0.5 ? dvec3(0.0, 0.0, 1.0) : dvec3(0.0, 1.0, 0.0);
        view.heading = -flatten(other, views.up()) * glm::dot(view.direction, views.up());
    }
    return view;
}

/// Rotation with -Z along `direction` and +Y towards the path's `up`.
///
/// Straight down and up (to 1e-6 of the angle) `up` gives no roll: the view then has the roll of
/// the path's arrival or, at the beginning of a shot, of its departure. So a path that leaves in
/// another direction than it arrived, such as one that flies over its target, does not flip: it
/// continues as it arrived, and rolls until it is upright at the next key. If the view is vertical
/// throughout, +Y is the axis that `up` is farthest from. A target at the camera's own position is
/// handled likewise: the view direction is that of arrival.
/// \param place in the path
/// \param direction from the camera to its target there, any length
dquat lookAlongPath(const PathMotion& path, const KeyPlace& place, const dvec3& direction) {
    const ViewDirections views(path, place.shot);
    const dvec3& up = views.up();
    ViewDirection view{normalizeOrZero(direction), normalizeOrZero(direction)};
    const bool isVertical = !isUpright(direction, up);
    if (isVertical)
        view = completeView(views, place, direction);
    if (view.direction == dvec3(0.0))
        return {1.0, 0.0, 0.0, 0.0};
    dmat3 axes = makeAxes(view, up);
    if (place.share > 0.0) {
        const double radians = findRoll(views, views.span(place.key), place, isVertical);
        if (radians != 0.0)
            axes = roll(axes, radians);
    }
    return glm::quat_cast(axes);
}

core::Status validateKey(const PathMotion& path, size_t i) {
    const PathKey& key = path.keys[i];
    if (!std::isfinite(key.seconds))
        return core::makeError("path: the time of key {} is {}", i, key.seconds);
    if (i > 0 && !(key.seconds > path.keys[i - 1].seconds))
        return core::makeError(
            "path: key {} at {} s does not come after the one before, at {} s",
            i,
            key.seconds,
            path.keys[i - 1].seconds
        );
    if (!isFinite(key.position))
        return core::makeError("path: the position of key {} is not finite", i);
    if (key.rotation && key.lookAt)
        return core::makeError("path: key {} has a rotation and a place to look at", i);
    if (key.rotation.has_value() != path.keys[0].rotation.has_value() ||
        key.lookAt.has_value() != path.keys[0].lookAt.has_value())
        return core::makeError("path: key {} states its direction in another way than key 0", i);
    // Written so that NaN fails.
    if (key.rotation && !(std::abs(glm::length(*key.rotation) - 1.0) < 1.0e-3))
        return core::makeError("path: the rotation of key {} is not of length 1", i);
    if (key.lookAt && !isFinite(*key.lookAt))
        return core::makeError("path: the place that key {} looks at is not finite", i);
    return {};
}

} // namespace

core::Status validatePath(const PathMotion& path) {
    if (path.keys.empty())
        return core::makeError("path: it has no keys");
    for (size_t i = 0; i < path.keys.size(); ++i)
        SHUTTER_TRY(validateKey(path, i));
    if (!isFinite(path.up) || !(glm::length(path.up) > 0.0))
        return core::makeError("path: up has no direction");
    return {};
}

math::Transform samplePath(const PathMotion& path, const math::Transform& rest, double seconds) {
    SHUTTER_CHECK(!path.keys.empty(), "a path without keys");
    const std::vector<PathKey>& keys = path.keys;
    const KeyPlace place = findKeyPlace(keys, path.ease, seconds);
    math::Transform pose = rest;
    pose.translation =
        interpolate<dvec3>(path, place, [&](size_t key) { return keys[key].position; });
    if (keys.front().rotation)
        pose.rotation = sampleRotation(path, place);
    if (keys.front().lookAt) {
        const dvec3 target =
            interpolate<dvec3>(path, place, [&](size_t key) { return *keys[key].lookAt; });
        pose.rotation = lookAlongPath(path, place, target - pose.translation);
    }
    return pose;
}

bool hasCutWithin(const PathMotion& path, double from, double to) {
    return hasCutKeyWithin(path.keys, from, to);
}

} // namespace shutter::scene
