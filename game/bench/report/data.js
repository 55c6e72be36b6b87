// SPDX-License-Identifier: MIT
// The results, questions about them, and what the reader has chosen.

const results = JSON.parse(document.getElementById("results").textContent);
const pictureFiles = JSON.parse(document.getElementById("picture-files").textContent);
const filmFiles = JSON.parse(document.getElementById("film-files").textContent);

const methodByName = new Map(results.methods.map((method) => [method.name, method]));
const metricById = new Map(results.metrics.map((metric) => [metric.id, metric]));

/**
 * Methods that a truth was made with. Against it they are judged by themselves, which shows how fast
 * they converge and not how right they are: plots hide them at first, rankings leave them out.
 */
const truthMethods = new Set(results.cases.map((theCase) => theCase.truth.method));

/** What the reader has chosen; change it with `choose`. `time`: "frame" or "effect". */
const chosen = {
    case: results.cases[0] ?? null,
    metric: results.metrics[0] ?? null,
    time: "frame",
    hidden: new Set(truthMethods),
};
const choiceListeners = [];

function onChoice(listener) {
    choiceListeners.push(listener);
}

function choose(changes) {
    Object.assign(chosen, changes);
    for (const listener of choiceListeners) listener();
}

/** null stands for a picture equal to the truth, whose PSNR is infinite. */
function metricOf(measurement, metric) {
    const value = measurement.metrics[metric.id];
    if (value === undefined) return Number.NaN;
    return value === null ? Number.POSITIVE_INFINITY : value;
}

/** Quartiles in ms of what the reader has chosen. */
function timeOf(measurement) {
    return measurement.milliseconds[chosen.time];
}

function isBetter(metric, a, b) {
    return metric.better === "higher" ? a > b : a < b;
}

/** How much better `a` is than `b`: positive is better, whichever way the metric runs. */
function gain(metric, a, b) {
    return metric.better === "higher" ? a - b : b - a;
}

function defaultOf(theCase, methodName) {
    return theCase.measurements.find((m) => m.method === methodName && m.isDefault);
}

/** Methods that a case was measured with, in the order of the list of methods. */
function methodsOf(theCase) {
    return results.methods.filter((method) =>
        theCase.measurements.some((m) => m.method === method.name));
}

function median(values) {
    if (values.length === 0) return Number.NaN;
    const sorted = [...values].sort((a, b) => a - b);
    const middle = Math.floor(sorted.length / 2);
    if (sorted.length % 2 === 1) return sorted[middle];
    return (sorted[middle - 1] + sorted[middle]) / 2;
}

/**
 * Those of `points` ({time, value}) that no other beats in one while it is as good in the other,
 * by rising time. Points without a number in both take no part.
 */
function findParetoFront(points, metric) {
    const usable = points.filter((p) => Number.isFinite(p.time) && !Number.isNaN(p.value));
    usable.sort((a, b) => a.time - b.time || gain(metric, b.value, a.value));
    const front = [];
    for (const point of usable) {
        const best = front.at(-1);
        const equal = best && point.time === best.time && point.value === best.value;
        if (!best || equal || isBetter(metric, point.value, best.value)) front.push(point);
    }
    return front;
}

/**
 * One row per method at its default sample count, over `cases`: medians of time and of every
 * metric, by rising time. A method without a measurement in some of the cases is left out: its median would
 * be of other cases than the rest's.
 */
function summarize(cases) {
    const rows = [];
    for (const method of results.methods) {
        const found = cases.map((c) => defaultOf(c, method.name)).filter(Boolean);
        if (found.length === 0 || found.length < cases.length) continue;
        rows.push({
            method,
            samples: found[0].samples,
            time: median(found.map((m) => timeOf(m).median)),
            metrics: Object.fromEntries(results.metrics.map((metric) =>
                [metric.id, median(found.map((m) => metricOf(m, metric)))])),
        });
    }
    return rows.sort((a, b) => a.time - b.time);
}
