// SPDX-License-Identifier: MIT
#include "game/blur/cameras.h"

#include "engine/json/json_file.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::blur {

namespace {

using json::JsonNode;
using json::JsonObject;

constexpr double kMaxFrame = 1.0e7;

glm::dmat4 readMatrix(const JsonNode& node) {
    const std::array<double, 16> numbers = node.readNumbers<16>();
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i)
        matrix[i / 4][i % 4] = numbers[size_t(i)];
    return matrix;
}

/// A camera in the world, as glTF has them: it looks along -Z, and +Y is up.
glm::dmat4 readPlace(const JsonObject& object) {
    const std::array<double, 3> at = object.require("position").readNumbers<3>();
    const JsonNode node = object.require("rotation");
    const std::array<double, 4> q = node.readNumbers<4>();
    const glm::dquat rotation(q[3], q[0], q[1], q[2]);
    if (!(std::abs(glm::length(rotation) - 1.0) < 1.0e-3))
        node.fail("must be of length 1 (x, y, z, w), not {}", glm::length(rotation));
    glm::dmat4 worldFromView = glm::mat4_cast(glm::normalize(rotation));
    worldFromView[3] = {at[0], at[1], at[2], 1.0};
    return glm::inverse(worldFromView);
}

/// The range of depth does not matter: pictures hold distances.
glm::dmat4 readProjection(const JsonNode& fieldOfView, double aspect) {
    const double degrees = fieldOfView.readNumber({0.0, 180.0, true, true});
    const double scale = 1.0 / std::tan(glm::radians(degrees > 0.0 ? degrees : 90.0) / 2.0);
    glm::dmat4 clipFromView(0.0);
    clipFromView[0][0] = scale / aspect;
    clipFromView[1][1] = -scale; // y = -1 is the top
    clipFromView[2][3] = -1.0;
    clipFromView[3][2] = 0.1;
    return clipFromView;
}

PictureCamera readCamera(const JsonNode& node, double aspect) {
    const JsonObject object = node.readObject(
        {"frame", "position", "rotation", "fieldOfView", "viewFromWorld", "clipFromView"}
    );
    PictureCamera camera;
    if (const auto frame = object.find("frame"))
        camera.frame = frame->readNumber({-kMaxFrame, kMaxFrame});
    const auto view = object.find("viewFromWorld");
    camera.viewFromWorld = view ? readMatrix(*view) : readPlace(object);
    const auto clip = object.find("clipFromView");
    camera.clipFromView =
        clip ? readMatrix(*clip) : readProjection(object.require("fieldOfView"), aspect);
    for (const glm::dmat4& matrix : {camera.viewFromWorld, camera.clipFromView})
        if (!(std::abs(glm::determinant(matrix)) > 0.0))
            node.fail("has a matrix that is singular");
    return camera;
}

} // namespace

const PictureCamera* Cameras::find(double frame) const {
    if (list.size() == 1)
        return &list.front();
    const auto found = std::find_if(list.begin(), list.end(), [&](const PictureCamera& one) {
        return std::abs(one.frame - frame) < 1.0e-6;
    });
    return found == list.end() ? nullptr : &*found;
}

core::Result<Cameras> readCameras(const std::filesystem::path& file, double aspect) {
    return json::readJsonFile(file, [&](const JsonNode& node) {
        const JsonObject root = node.readObject({"cameras"});
        Cameras cameras;
        for (const JsonNode& one : root.require("cameras").readArray(1)) {
            const PictureCamera camera = readCamera(one, aspect);
            if (!cameras.list.empty() && !(camera.frame > cameras.list.back().frame))
                one.fail("must be of a later frame than {}", cameras.list.back().frame);
            const bool aheadIsPlusZ = camera.clipFromView[2][3] > 0.0;
            if (!cameras.list.empty() && aheadIsPlusZ != cameras.aheadIsPlusZ)
                one.fail("must look along the axis that the camera before does");
            cameras.aheadIsPlusZ = aheadIsPlusZ;
            cameras.list.push_back(camera);
        }
        return cameras;
    });
}

} // namespace shutter::blur
