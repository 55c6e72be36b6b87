// SPDX-License-Identifier: MIT
// One colour and one marker a method, the same in every plot and legend. Filled: traces rays.

const kShapes = [
    {style: "circle", rotation: 0, path: "M8 2a6 6 0 1 0 .01 0z"},
    {style: "triangle", rotation: 0, path: "M8 2l6 11H2z"},
    {style: "rect", rotation: 0, path: "M3 3h10v10H3z"},
    {style: "rectRot", rotation: 0, path: "M8 1l7 7-7 7-7-7z"},
    {style: "triangle", rotation: 180, path: "M8 14l6-11H2z"},
    {style: "triangle", rotation: 90, path: "M14 8L3 2v12z"},
    {style: "triangle", rotation: 270, path: "M2 8l11-6v12z"},
];
const kSeriesColors = 12;

function cssColor(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** {color, shape, filled} of a method; the place in the list of methods decides. */
function markOf(methodName) {
    const index = results.methods.findIndex((method) => method.name === methodName);
    return {
        color: cssColor(`--series-${index % kSeriesColors}`),
        shape: kShapes[index % kShapes.length],
        filled: Boolean(methodByName.get(methodName)?.usesRays),
    };
}

/** The marker as a small picture beside text. */
function markIcon(methodName) {
    const index = results.methods.findIndex((method) => method.name === methodName);
    const {shape, filled} = markOf(methodName);
    const color = `var(--series-${index % kSeriesColors})`;
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("viewBox", "0 0 16 16");
    svg.setAttribute("class", "mark");
    svg.setAttribute("aria-hidden", "true");
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", shape.path);
    path.setAttribute("style",
        `fill:${filled ? color : "var(--paper)"};stroke:${color};stroke-width:2`);
    svg.append(path);
    return svg;
}
