// SPDX-License-Identifier: MIT
// What accuracy costs in time: a line per case, from the cheapest of the measured methods to the truth.

/** A case's measurements in the order of the methods, which a suite with a dial lists from cheap to good. */
function listDial(theCase, metric) {
    return methodsOf(theCase).flatMap((method) => theCase.measurements
        .filter((m) => m.method === method.name)
        .sort((a, b) => (a.samples ?? 0) - (b.samples ?? 0)))
        .map((measurement) => ({
            x: timeOf(measurement).median,
            y: metricOf(measurement, metric),
            quartiles: [timeOf(measurement).q1, timeOf(measurement).q3],
            measurement,
        }))
        .filter((point) => point.x > 0 && Number.isFinite(point.y));
}

/** Names each line at its end, and the methods that are no variants on the first one. */
function nameDialPoints(points, theCase, isFirst) {
    for (const point of points) {
        const {method} = point.measurement;
        if (point === points.at(-1)) point.name = theCase.name;
        else if (isFirst && ["gather", "hybrid", "resolved", "adaptive"].includes(method))
            point.name = method;
    }
    return points;
}

/** Samples of what made or could have made the truth are a line of their own. */
function isOfTruth({measurement}) {
    return measurement.method === "truth";
}

function makeDialSet(label, color, points, dash) {
    const mark = (p) => markOf(p.measurement.method);
    return {
        label,
        data: points,
        showLine: true,
        borderColor: color,
        borderWidth: 1.5,
        borderDash: dash,
        pointRadius: 5,
        pointBorderColor: color,
        pointBackgroundColor: points.map((p) => (mark(p).filled ? color : cssColor("--paper"))),
        pointStyle: points.map((p) => mark(p).shape.style),
        pointRotation: points.map((p) => mark(p).shape.rotation),
    };
}

function drawDial() {
    const {metric} = chosen;
    if (results.suite !== "dial" || !metric) return;
    reveal("dial");
    const sets = results.cases.flatMap((theCase, i) => {
        const points = listDial(theCase, metric);
        const ours = nameDialPoints(points.filter((p) => !isOfTruth(p)), theCase, i === 0);
        const traced = points.filter(isOfTruth);
        if (i === 0 && traced.length > 0) {
            const {method, samples} = traced.at(-1).measurement;
            traced.at(-1).name = nameMeasurement(method, samples);
        }
        const color = cssColor(`--series-${i % kSeriesColors}`);
        return [makeDialSet(theCase.title, color, ours, []),
            makeDialSet(`${theCase.title}, truth`, color, traced, [3, 4])];
    });
    const [theCase] = results.cases;
    byId("dial-note").textContent = "Each line is a case, its points in the order " +
        `${methodsOf(theCase).map((method) => method.name).join(", ")}; truth is dashed. The reference ` +
        `is ${nameMeasurement(theCase.truth.method, theCase.truth.samples)}. Filled markers trace rays. ` +
        "Whiskers are quartiles of time; point at a marker for its figures.";
    byId("dial-legend").replaceChildren(...methodsOf(theCase).map((method) =>
        el("span", {}, methodLabel(method.name))));
    byId("dial-chart").setAttribute("aria-label", `${metric.name} against time, all cases`);
    const points = sets.flatMap((set) => set.data);
    drawChart(byId("dial-chart"), {
        data: {datasets: sets},
        scales: {
            x: makeAxis(`${chosen.time === "frame" ? "Frame time" : "Time of the effect"}, milliseconds (GPU, logarithmic)`, true, points.map((p) => p.x)),
            y: makeAxis(describeMetric(metric), false, []),
        },
        tooltip: tradeoffTooltip,
        whiskersAlong: "x",
    });
}
