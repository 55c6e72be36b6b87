// SPDX-License-Identifier: MIT
// Pictures of a case pixel by pixel: views that zoom and pan as one, over floats where there are some.

const kViewerMaxScale = 64;

/** `scale`: screen pixels a pixel of the picture; `x`, `y`: what of the picture is in the middle. */
const viewer = {
    shown: [], count: 2, active: 0, mode: "picture", exposure: 0, against: kReference,
    scale: 1, x: 0, y: 0, views: [], list: [], theCase: null, turn: 0,
};

function pictureOfView(view) {
    return viewer.list.find((picture) => picture.id === viewer.shown[view]) ?? viewer.list[0];
}

function againstOfViewer() {
    return viewer.list.find((picture) => picture.id === viewer.against) ?? viewer.list[0];
}

/** Baseline, headline's method, truth, sharp: so that two views already show what it is about. */
function chooseViews(list) {
    const {method, baseline} = headlineMethods();
    const wishes = [baseline, method, null, "sharp"];
    const found = wishes.map((wish) => list.find((picture) => picture.method === wish &&
        (picture.measurement?.isDefault ?? true)));
    return found.map((picture, i) => (picture ?? list[i % list.length]).id);
}

function sizeOfViewer() {
    return viewer.views.find((view) => view.layers)?.layers ?? null;
}

/** The scale at which `region` fills a view. */
function fitScale(region) {
    const {clientWidth, clientHeight} = viewer.views[0].canvas;
    return Math.min(clientWidth / region.width, clientHeight / region.height);
}

function lookAt(region) {
    viewer.scale = Math.min(fitScale(region), kViewerMaxScale);
    viewer.x = region.x + region.width / 2;
    viewer.y = region.y + region.height / 2;
    placeViews();
}

function resetViewer() {
    const size = sizeOfViewer();
    if (size) lookAt({x: 0, y: 0, width: size.width, height: size.height});
}

/** Zooms so that the picture's point under `at` (pixels from a view's middle) stays there. */
function zoomViewer(factor, at = {x: 0, y: 0}) {
    const size = sizeOfViewer();
    if (!size) return;
    const least = Math.min(fitScale({width: size.width, height: size.height}), 1);
    const scale = Math.min(Math.max(viewer.scale * factor, least), kViewerMaxScale);
    viewer.x += at.x / viewer.scale - at.x / scale;
    viewer.y += at.y / viewer.scale - at.y / scale;
    viewer.scale = scale;
    placeViews();
}

/** By screen pixels; what is in the middle stays a point of the picture. */
function panViewer(dx, dy) {
    const size = sizeOfViewer();
    if (!size) return;
    viewer.x = Math.min(Math.max(viewer.x - dx / viewer.scale, 0), size.width);
    viewer.y = Math.min(Math.max(viewer.y - dy / viewer.scale, 0), size.height);
    placeViews();
}

/** The picture's pixel under a place in a view; null outside. */
function pixelAt(view, clientX, clientY) {
    const {layers, canvas} = view;
    if (!layers) return null;
    const box = canvas.getBoundingClientRect();
    const x = Math.floor(viewer.x + (clientX - box.left - box.width / 2) / viewer.scale);
    const y = Math.floor(viewer.y + (clientY - box.top - box.height / 2) / viewer.scale);
    return x >= 0 && y >= 0 && x < layers.width && y < layers.height ? {x, y} : null;
}

function placeView({canvas, layers, painted}) {
    if (!painted) return;
    const ratio = devicePixelRatio;
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round(canvas.clientHeight * ratio);
    const context = canvas.getContext("2d");
    const scale = viewer.scale * ratio;
    context.imageSmoothingEnabled = scale < 1;
    context.setTransform(scale, 0, 0, scale,
        canvas.width / 2 - viewer.x * scale, canvas.height / 2 - viewer.y * scale);
    context.drawImage(painted, 0, 0);
    if (layers.patches.some((patch) => patch.width === layers.width)) return;
    context.lineWidth = ratio / scale;
    context.strokeStyle = "rgb(255 255 255 / 80%)";
    for (const {x, y, width, height} of layers.patches) context.strokeRect(x, y, width, height);
}

function placeViews() {
    viewer.views.forEach(placeView);
    const {scale, x, y} = viewer;
    Object.assign(byId("viewer-stage").dataset, {scale, x, y});
}

function paintView(view, layers, against, look) {
    const canvas = el("canvas", {width: layers.width, height: layers.height});
    canvas.getContext("2d").putImageData(paintLayers(layers, against, look), 0, 0);
    view.layers = layers;
    view.painted = canvas;
}

function describeDetail({layers}) {
    if (layers.patches.some((patch) => patch.width === layers.width))
        return "Every pixel is linear light in half floats.";
    const quality = pictureFiles.detail.jpegQuality;
    const rest = quality === null ? "8 bits" : `8 bits, JPEG of quality ${quality}`;
    const whole = `pixels are what was displayed (${rest}), which exposure scales`;
    return layers.patches.length === 0 ? `All ${whole}.`
        : `Inside the frames pixels are linear light in half floats; outside, ${whole}.`;
}

/** Paints anew what is shown; whatever was asked for later wins. */
async function paintViews() {
    const turn = ++viewer.turn;
    const stage = byId("viewer-stage");
    stage.dataset.state = "painting";
    const isFirst = sizeOfViewer() === null;
    const look = makeLook(viewer.theCase, viewer.mode, viewer.exposure);
    const pictures = viewer.views.map((_, i) => pictureOfView(i));
    const layers = await Promise.all(pictures.map(loadLayers));
    const against = viewer.mode === "difference" ? await loadLayers(againstOfViewer()) : null;
    if (turn !== viewer.turn) return;
    viewer.views.forEach((view, i) => {
        paintView(view, layers[i], against, look);
        view.tag.textContent = pictures[i].label;
        view.canvas.setAttribute("aria-label", pictures[i].label);
        view.canvas.style.aspectRatio = `${layers[i].width} / ${layers[i].height}`;
    });
    byId("viewer-note").textContent = describeDetail(viewer.views[0]);
    if (isFirst) resetViewer();
    else placeViews();
    stage.dataset.state = "painted";
}

function makeView(index) {
    const canvas = el("canvas", {role: "img"});
    const tag = el("span", {class: "tag left"});
    const box = el("div", {class: "view", "data-view": index}, canvas, tag);
    return {canvas, tag, box, layers: null, painted: null};
}

/** What the controls say, by what the reader chose. */
function tellViewerState() {
    const active = pictureOfView(viewer.active).id;
    viewer.views.forEach((view, i) => view.box.classList.toggle("active", i === viewer.active));
    byId("viewer-pictures").replaceChildren(...viewer.list.map((picture, i) =>
        el("button", {
            type: "button", "data-picture": picture.id,
            "aria-pressed": String(picture.id === active),
            onclick: () => showPicture(i),
        }, el("kbd", {}, i < 10 ? String((i + 1) % 10) : `⇧${(i + 1) % 10}`), ` ${picture.label}`)));
    byId("viewer-mode").value = viewer.mode;
    byId("viewer-exposure").value = String(viewer.exposure);
    byId("viewer-stops").textContent = `${formatSigned(viewer.exposure, 1)} stops`;
    byId("viewer-against-choice").hidden = viewer.mode !== "difference";
    byId("viewer-exposure").disabled = viewer.mode === "flip";
}

function changeViewer(changes) {
    Object.assign(viewer, changes);
    tellViewerState();
    paintViews().catch((error) => tellFailure(`a picture: ${error.message}`));
}

/** Puts the picture of that place in the list into the active view. */
function showPicture(place) {
    if (place < viewer.list.length) {
        viewer.shown[viewer.active] = viewer.list[place].id;
        changeViewer({});
    }
}

function setViewCount(count) {
    viewer.count = count;
    viewer.views = Array.from({length: count}, (_, i) => makeView(i));
    const stage = byId("viewer-stage");
    stage.replaceChildren(...viewer.views.map((view) => view.box));
    stage.dataset.views = String(count);
    changeViewer({active: Math.min(viewer.active, count - 1)});
}

function drawViewer() {
    const theCase = chosen.case;
    const list = theCase ? picturesOf(theCase) : [];
    byId("viewer").hidden = list.length === 0;
    if (list.length === 0 || viewer.theCase === theCase) return;
    const kept = viewer.shown.filter((id) => list.some((picture) => picture.id === id));
    viewer.shown = kept.length === viewer.shown.length && kept.length > 0 ? kept : chooseViews(list);
    Object.assign(viewer, {theCase, list});
    const options = list.map(({id, label}) => ({value: id, label}));
    fillSelect(byId("viewer-against"), options, againstOfViewer().id);
    fillSelect(byId("viewer-region"), [{value: "whole", label: "whole picture"},
        ...(theCase.crops ?? []).map((crop, i) => (
            {value: String(i), label: `${i + 1}: ${crop.label}`}))], "whole");
    setViewCount(viewer.count);
}
