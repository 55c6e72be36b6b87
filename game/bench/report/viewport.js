// SPDX-License-Identifier: MIT
// A picture, whole or a part of it enlarged without smoothing, and the list of pictures of a case.

/** The id of the picture that the others are compared with. */
const kReference = "truth-reference";

/** Pictures of a case that are in this file: the truth first, then by method and sample count. */
function picturesOf(theCase) {
    const list = [];
    const {truth} = theCase;
    if (truth.image) {
        list.push({
            id: kReference,
            method: null,
            label: `the truth (${nameMeasurement(truth.method, truth.samples)})`,
            image: truth.image,
            measurement: null,
        });
    }
    for (const measurement of theCase.measurements) {
        if (!measurement.image) continue;
        const label = nameMeasurement(measurement.method, measurement.samples);
        list.push({
            id: label,
            method: measurement.method,
            label,
            image: measurement.image,
            errorMap: measurement.errorMap,
            measurement,
        });
    }
    return list;
}

/** Whether a region lies within another. */
function holds(outer, inner) {
    return outer.x <= inner.x && outer.y <= inner.y &&
        outer.x + outer.width >= inner.x + inner.width &&
        outer.y + outer.height >= inner.y + inner.height;
}

/**
 * A box that shows `region` ({x, y, width, height} in pixels; null: all) of a picture file.
 * Enlarged pixels stay squares.
 */
function makeViewport(file, region, description) {
    const part = region
        ? (pictureFiles.parts[file] ?? []).find((one) => holds(one, region)) : null;
    const image = el("img", {alt: description, draggable: "false"});
    const box = el("div", {class: region ? "viewport crop" : "viewport"}, image);
    if (region) {
        const from = part ? {x: region.x - part.x, y: region.y - part.y} : region;
        box.style.aspectRatio = `${region.width} / ${region.height}`;
        image.addEventListener("load", () => {
            image.style.width = `${(image.naturalWidth / region.width) * 100}%`;
            image.style.left = `${(-from.x / region.width) * 100}%`;
            image.style.top = `${(-from.y / region.height) * 100}%`;
        });
    }
    image.src = part?.uri ?? pictureFiles.whole[file];
    return box;
}

/** Numbered frames over a whole picture, one per crop. */
function addCropFrames(box, theCase) {
    const image = box.firstElementChild;
    image.addEventListener("load", () => {
        (theCase.crops ?? []).forEach((crop, i) => {
            const frame = el("span", {class: "frame"}, el("b", {}, String(i + 1)));
            frame.style.left = `${(crop.x / image.naturalWidth) * 100}%`;
            frame.style.top = `${(crop.y / image.naturalHeight) * 100}%`;
            frame.style.width = `${(crop.width / image.naturalWidth) * 100}%`;
            frame.style.height = `${(crop.height / image.naturalHeight) * 100}%`;
            box.append(frame);
        });
    });
}
