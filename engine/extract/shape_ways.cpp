// SPDX-License-Identifier: MIT
#include "engine/extract/shape_ways.h"

namespace shutter::extract {

namespace {

using math::dmat4;
using math::vec4;

/// Rows of the map to (x q, y q, q): q is the depth, or 1 before an orthographic camera.
void writeRows(const dmat4& pictureFromObject, bool isPerspective, vec4 (&rows)[3]) {
    const dmat4 byRow = glm::transpose(pictureFromObject);
    rows[0] = vec4(byRow[0]);
    rows[1] = vec4(byRow[1]);
    rows[2] = isPerspective ? vec4(byRow[2]) : vec4(0.0f, 0.0f, 0.0f, 1.0f);
}

} // namespace

shader::ShapeWayRow makeShapeWayRow(
    const math::mat4& clipFromObject,
    const dmat4& pictureFromObject,
    const ExposurePictures& pictures,
    const ExposurePlaces& places,
    bool isPerspective
) {
    shader::ShapeWayRow row{};
    row.clipFromObject = clipFromObject;
    vec4 raster[3];
    writeRows(pictureFromObject, isPerspective, raster);
    for (int i = 0; i < 3; ++i)
        row.raster[i] = raster[i];
    row.raster[3] = vec4(glm::transpose(pictureFromObject)[2]);
    writeRows(pictures[0] * places[0], isPerspective, row.open);
    writeRows(pictures[1] * places[1], isPerspective, row.middle);
    writeRows(pictures[2] * places[2], isPerspective, row.close);
    return row;
}

} // namespace shutter::extract
