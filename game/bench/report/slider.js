// SPDX-License-Identifier: MIT
// Two pictures, one over the other, with a line between them that the reader moves.

const comparison = {left: null, right: null, region: "whole", percent: 50};

function placeSlider(percent) {
    comparison.percent = Math.min(100, Math.max(0, percent));
    const {percent: shown} = comparison;
    byId("slider-over").style.clipPath = `inset(0 ${100 - shown}% 0 0)`;
    const handle = byId("slider-handle");
    handle.style.left = `${shown}%`;
    handle.setAttribute("aria-valuenow", String(Math.round(shown)));
    handle.setAttribute("aria-valuetext", `${Math.round(shown)} % is the left picture`);
}

/** Pictures and error maps, as choices of the slider. */
function listLayers(theCase) {
    return picturesOf(theCase).flatMap((picture) => {
        const layers = [{
            id: picture.id, label: picture.label, file: picture.image, picture,
        }];
        if (picture.errorMap) {
            layers.push({
                id: `${picture.id}: error`, label: `${picture.label}: FLIP error map`,
                file: picture.errorMap, picture: null,
            });
        }
        return layers;
    });
}

function drawSlider() {
    const theCase = chosen.case;
    const layers = theCase ? listLayers(theCase) : [];
    byId("slider").hidden = layers.length < 2;
    if (layers.length < 2) return;
    const pick = (id, method, fallback) => layers.find((layer) => layer.id === id) ??
        layers.find((layer) => layer.picture?.method === method &&
            layer.picture.measurement.isDefault) ?? fallback;
    const right = pick(comparison.right, headlineMethods().method, layers[1]);
    const left = pick(comparison.left, headlineMethods().baseline, layers.find((layer) => layer !== right));
    const crops = theCase.crops ?? [];
    const region = crops[Number(comparison.region)] ?? null;
    const options = layers.map(({id, label}) => ({value: id, label}));
    fillSelect(byId("slider-left"), options, left.id);
    fillSelect(byId("slider-right"), options, right.id);
    fillSelect(byId("slider-region"), [{value: "whole", label: "whole picture"},
        ...crops.map((crop, i) => ({value: String(i), label: `${i + 1}: ${crop.label}`}))],
        region ? comparison.region : "whole");
    byId("slider-over").replaceChildren(makeViewport(left.file, region, left.label),
        el("span", {class: "tag left"}, left.label));
    byId("slider-under").replaceChildren(makeViewport(right.file, region, right.label),
        el("span", {class: "tag right"}, right.label));
    placeSlider(comparison.percent);
}

for (const side of ["left", "right", "region"]) {
    byId(`slider-${side}`).addEventListener("change", (event) => {
        comparison[side] = event.target.value;
        drawSlider();
    });
}

const sliderFrame = byId("slider-frame");
const followPointer = (event) => {
    const box = sliderFrame.getBoundingClientRect();
    placeSlider(((event.clientX - box.left) / box.width) * 100);
};
sliderFrame.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    sliderFrame.setPointerCapture(event.pointerId);
    byId("slider-handle").focus({preventScroll: true});
    followPointer(event);
    event.preventDefault();
});
sliderFrame.addEventListener("pointermove", (event) => {
    if (sliderFrame.hasPointerCapture(event.pointerId)) followPointer(event);
});

byId("slider-handle").addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 10 : 1;
    const moves = {
        ArrowLeft: -step, ArrowDown: -step, ArrowRight: step, ArrowUp: step,
        PageDown: -10, PageUp: 10, Home: -100, End: 100,
    };
    if (!(event.key in moves)) return;
    placeSlider(comparison.percent + moves[event.key]);
    event.preventDefault();
});
