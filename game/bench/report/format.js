// SPDX-License-Identifier: MIT
// Numbers as people read them, and HTML elements.

const kDecimals = {psnr: 2, ssim: 4, flip: 4, linearPsnr: 2};

/** `text` on one line; a missing figure is a dash. */
function formatNumber(value, decimals) {
    if (value === Number.POSITIVE_INFINITY) return "∞";
    if (!Number.isFinite(value)) return "–";
    return value.toLocaleString("en", {
        minimumFractionDigits: decimals,
        maximumFractionDigits: decimals,
    });
}

/** Three significant digits or so, in milliseconds. */
function formatMs(value) {
    const size = Math.abs(value);
    return formatNumber(value, size < 10 ? 2 : size < 100 ? 1 : 0);
}

function formatRatio(value) {
    return `${formatNumber(value, value < 10 ? 1 : 0)}×`;
}

function formatMetric(metric, value) {
    return formatNumber(value, kDecimals[metric.id] ?? 3);
}

function formatSigned(value, decimals) {
    const text = formatNumber(Math.abs(value), decimals);
    return `${value < 0 ? "−" : "+"}${text}`;
}

function withUnit(text, unit) {
    return unit ? `${text} ${unit}` : text;
}

/** "PSNR (dB), higher is better" */
function describeMetric(metric) {
    const name = metric.unit ? `${metric.name} (${metric.unit})` : metric.name;
    return `${name}, ${metric.better} is better`;
}

function nameSamples(methodName, samples) {
    if (samples === null || samples === undefined) return "";
    const unit = methodByName.get(methodName)?.sampleUnit;
    if (unit === undefined) return formatNumber(samples, 0);
    if (unit === "none") return "";
    return samples === 1 ? `1 ${unit.replace(/s$/, "")}` : `${formatNumber(samples, 0)} ${unit}`;
}

/** "1 case", "12 cases" */
function countOf(count, noun) {
    return `${formatNumber(count, 0)} ${noun}${count === 1 ? "" : "s"}`;
}

/** "hybrid, 15 samples" */
function nameMeasurement(methodName, samples) {
    const amount = nameSamples(methodName, samples);
    return amount ? `${methodName}, ${amount}` : methodName;
}

function el(tag, attributes = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
        else if (value === true) element.setAttribute(name, "");
        else if (value !== false && value !== undefined) element.setAttribute(name, value);
    }
    element.append(...children.filter((child) => child !== null && child !== undefined));
    return element;
}

function byId(id) {
    return document.getElementById(id);
}

/** Reports at the top of the page what went wrong after the page was drawn. */
function reportFailure(message) {
    byId("failure").hidden = false;
    byId("failure").textContent = `This page could not be drawn in full: ${message}.`;
}

/** Shows a section that is not empty. */
function reveal(id) {
    byId(id).hidden = false;
}

/** A table; the first column is the rows' name. Cells: text, nodes, or {text, class, node}. */
function makeTable(columns, rows, attributes = {}) {
    const cellOf = (tag, cell, extra = {}) => {
        const plain = typeof cell !== "object" || cell === null || cell instanceof Node;
        const {content, ...rest} = plain ? {content: cell} : cell;
        return el(tag, {...extra, ...rest}, content ?? "–");
    };
    const head = el("tr", {}, ...columns.map((column) => cellOf("th", column, {scope: "col"})));
    const body = rows.map((row) => el("tr", {}, ...row.map((cell, i) =>
        i === 0 ? cellOf("th", cell, {scope: "row"}) : cellOf("td", cell))));
    const table = el("table", attributes, el("thead", {}, head), el("tbody", {}, ...body));
    return el("div", {class: "scroll"}, table);
}

function methodLabel(methodName, samples) {
    const amount = nameSamples(methodName, samples);
    return el("span", {class: "method", title: methodByName.get(methodName)?.title ?? ""},
        markIcon(methodName), methodName,
        amount ? el("span", {class: "sample-count"}, ` ${amount}`) : null);
}

function fillSelect(select, options, selected) {
    select.replaceChildren(...options.map(({value, label}) =>
        el("option", {value, selected: value === selected}, label)));
}
