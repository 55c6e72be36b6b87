// SPDX-License-Identifier: MIT
// The paper's figure: four pictures side by side, crops below them, error maps instead.

const kPanels = 4;
/** Pictures that the reader put into the panels, by place; what is not there falls back. */
const panelChoices = [];

/** sharp, the headline's two methods, truth where they are there; what is there, in order, where not. */
function choosePanels(list) {
    const taken = new Set();
    const take = (wanted) => {
        const found = list.find((p) => !taken.has(p.id) && wanted(p));
        if (found) taken.add(found.id);
        return found;
    };
    const ofMethod = (name) => (p) => p.method === name && p.measurement.isDefault;
    const {method, baseline} = headlineMethods();
    const wishes = [ofMethod("sharp"), ofMethod(baseline), ofMethod(method),
        (p) => p.measurement === null];
    const panels = [];
    for (let i = 0; i < kPanels; ++i) {
        const picture = list.find((p) => p.id === panelChoices[i]) ?? take(wishes[i]) ??
            take((p) => p.measurement?.isDefault) ?? take(() => true);
        if (picture) panels.push(picture);
    }
    return panels;
}

function captionOf(picture) {
    if (!picture.measurement) return "what the others are compared with";
    const time = formatMs(timeOf(picture.measurement).median);
    const metrics = results.metrics.map((metric) =>
        `${metric.name} ${formatMetric(metric, metricOf(picture.measurement, metric))}`);
    return `${time} ms · ${metrics.join(" · ")}`;
}

function makePanel(theCase, list, picture, place, kind) {
    const select = el("select", {
        "aria-label": `Picture in place ${place + 1}`,
        onchange: (event) => {
            panelChoices[place] = event.target.value;
            drawPictures();
        },
    });
    fillSelect(select, list.map((p) => ({value: p.id, label: p.label})), picture.id);
    const file = picture[kind];
    const figure = el("figure", {"data-picture": picture.id}, select);
    if (!file) {
        const why = picture.measurement ? "no error map was kept" : "the truth has no error";
        figure.append(el("div", {class: "viewport none"}, why));
        return figure;
    }
    const whole = makeViewport(file, null, `${picture.label}, ${theCase.title}`);
    addCropFrames(whole, theCase);
    figure.append(whole, el("figcaption", {}, captionOf(picture)));
    (theCase.crops ?? []).forEach((crop, i) => {
        const box = makeViewport(file, crop, `${picture.label}, ${crop.label}`);
        figure.append(el("button", {
            type: "button", class: "crop-button", title: "Enlarge",
            "aria-label": `Enlarge ${crop.label} of ${picture.label}`,
            onclick: () => openZoom(theCase, list, crop, kind),
        }, box), el("span", {class: "small"}, `${i + 1}: ${crop.label}`));
    });
    return figure;
}

/** One crop of all panels, as large as the window allows. */
function openZoom(theCase, list, crop, kind) {
    const dialog = byId("zoom");
    const panels = choosePanels(list).filter((picture) => picture[kind]);
    const figures = panels.map((picture) => el("figure", {},
        makeViewport(picture[kind], crop, `${picture.label}, ${crop.label}`),
        el("figcaption", {}, picture.label)));
    dialog.replaceChildren(
        el("div", {class: "zoom-head"}, el("strong", {}, `${theCase.title}: ${crop.label}`),
            el("button", {type: "button", onclick: () => dialog.close()}, "Close")),
        el("div", {class: "zoom-grid"}, ...figures));
    dialog.showModal();
}

function drawPictures() {
    const theCase = chosen.case;
    const list = theCase ? picturesOf(theCase) : [];
    byId("pictures").hidden = list.length === 0;
    if (list.length === 0) return;
    const kind = document.querySelector("input[name=show]:checked").value;
    byId("pictures-show").hidden = !list.some((picture) => picture.errorMap);
    const {exposure, phase, camera, time} = theCase;
    byId("pictures-note").textContent = `${theCase.title}, camera ${camera}, at ` +
        `${formatNumber(time, 3)} s, exposure ${formatNumber(exposure * 1000, 1)} ms, raster ` +
        `instant at its ${phase}. Choose a crop to enlarge it.`;
    byId("pictures-scale").textContent = kind === "errorMap"
        ? "FLIP: black is no difference that a person would see, pale yellow the greatest." : "";
    byId("pictures-panels").replaceChildren(...choosePanels(list).map((picture, place) =>
        makePanel(theCase, list, picture, place, kind)));
}

for (const radio of document.querySelectorAll("input[name=show]"))
    radio.addEventListener("change", drawPictures);
