// SPDX-License-Identifier: MIT
// The viewer's keys, wheel, pointer and controls.

const kZoomStep = 1.25;
const kPanStepPx = 40;
const kMostStops = 8;

function exposeBy(stops) {
    if (viewer.mode === "flip") return;
    const exposure = Math.min(Math.max(viewer.exposure + stops, -kMostStops), kMostStops);
    changeViewer({exposure});
}

/** By KeyboardEvent.key. Digits are apart: with Shift, their key depends on the keyboard. */
const viewerKeys = {
    p: () => changeViewer({mode: "picture"}),
    d: () => changeViewer({mode: "difference"}),
    f: () => changeViewer({mode: "flip"}),
    e: () => exposeBy(0.5),
    E: () => exposeBy(-0.5),
    v: () => changeViewer({active: (viewer.active + 1) % viewer.count}),
    r: resetViewer,
    "+": () => zoomViewer(kZoomStep),
    "=": () => zoomViewer(kZoomStep),
    "-": () => zoomViewer(1 / kZoomStep),
    ArrowLeft: () => panViewer(kPanStepPx, 0),
    ArrowRight: () => panViewer(-kPanStepPx, 0),
    ArrowUp: () => panViewer(0, kPanStepPx),
    ArrowDown: () => panViewer(0, -kPanStepPx),
};

/** The place in the list that a digit key means: 1 to 9, 0 the tenth, ten more with Shift. */
function placeOfDigit(event) {
    const digit = /^(?:Digit|Numpad)([0-9])$/.exec(event.code)?.[1];
    return digit === undefined ? null : (Number(digit) + 9) % 10 + (event.shiftKey ? 10 : 0);
}

const viewerStage = byId("viewer-stage");

viewerStage.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const place = placeOfDigit(event);
    if (place !== null) showPicture(place);
    else if (event.key in viewerKeys) viewerKeys[event.key]();
    else return;
    event.preventDefault();
});

// A page that scrolls past must not zoom: the wheel does so once the viewer was clicked.
viewerStage.addEventListener("wheel", (event) => {
    const view = viewOf(event.target);
    if (document.activeElement !== viewerStage || !view) return;
    const box = view.canvas.getBoundingClientRect();
    zoomViewer(2 ** (-event.deltaY / 300), {
        x: event.clientX - box.left - box.width / 2,
        y: event.clientY - box.top - box.height / 2,
    });
    event.preventDefault();
}, {passive: false});

function viewOf(element) {
    const index = element.closest?.("[data-view]")?.dataset.view;
    return index === undefined ? null : viewer.views[Number(index)];
}

function describePixel(picture, layers, {x, y}) {
    const {color, error, isExact} = readPixel(layers, x, y);
    const values = color.map((value) => Number(value.toPrecision(4))).join(" ");
    const flip = error === null ? "" : `, FLIP ${formatNumber(error, 3)}`;
    return `${picture.label}: ${values}${flip}${isExact ? "" : " (8 bits)"}`;
}

function tellPixel(event) {
    const view = viewOf(event.target);
    const pixel = view ? pixelAt(view, event.clientX, event.clientY) : null;
    byId("viewer-pixel").textContent = pixel
        ? [`${pixel.x}, ${pixel.y}`, ...viewer.views.map((one, i) => one.layers
            ? describePixel(pictureOfView(i), one.layers, pixel) : "")].join(" · ")
        : "";
}

viewerStage.addEventListener("pointerdown", (event) => {
    const view = viewOf(event.target);
    if (event.button !== 0 || !view) return;
    viewerStage.focus({preventScroll: true});
    viewerStage.setPointerCapture(event.pointerId);
    viewer.active = viewer.views.indexOf(view);
    tellViewerState();
    event.preventDefault();
});
viewerStage.addEventListener("pointermove", (event) => {
    if (viewerStage.hasPointerCapture(event.pointerId)) panViewer(event.movementX, event.movementY);
    else tellPixel(event);
});

byId("viewer-count").addEventListener("change", (event) => setViewCount(Number(event.target.value)));
byId("viewer-mode").addEventListener("change", (event) => changeViewer({mode: event.target.value}));
byId("viewer-against").addEventListener("change", (event) =>
    changeViewer({against: event.target.value}));
byId("viewer-exposure").addEventListener("input", (event) =>
    changeViewer({exposure: Number(event.target.value)}));
byId("viewer-region").addEventListener("change", (event) => {
    const crop = viewer.theCase.crops?.[Number(event.target.value)];
    if (crop) lookAt(crop);
    else resetViewer();
});
byId("viewer-reset").addEventListener("click", resetViewer);
new ResizeObserver(placeViews).observe(viewerStage);
