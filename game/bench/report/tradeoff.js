// SPDX-License-Identifier: MIT
// Error against time: every measurement of a case, with a line through each method's and the Pareto
// front.

function describeCounters(measurement) {
    return Object.entries(measurement.counters ?? {})
        .map(([name, value]) => `${name}: ${formatNumber(value, 0)}`);
}

/** Points of one method by rising sample count; `omitted` takes the names of those without a place. */
function collectPoints(theCase, methodName, metric, omitted) {
    const found = theCase.measurements.filter((m) => m.method === methodName);
    found.sort((a, b) => (a.samples ?? 0) - (b.samples ?? 0));
    const points = [];
    for (const measurement of found) {
        const time = timeOf(measurement);
        const value = metricOf(measurement, metric);
        const name = nameMeasurement(methodName, measurement.samples);
        if (!(time.median > 0)) {
            omitted.push(`${name} (no time on a logarithmic axis: ${formatMs(time.median)} ms)`);
        } else if (!Number.isFinite(value)) {
            omitted.push(value === Number.POSITIVE_INFINITY
                ? `${name} (equal to the truth, in ${formatMs(time.median)} ms)`
                : `${name} (no ${metric.name})`);
        } else {
            points.push({
                x: time.median, y: value, quartiles: [time.q1, time.q3], measurement,
                name: measurement.isDefault ? methodName : undefined,
            });
        }
    }
    return points;
}

function makeFrontSet(points, metric) {
    const front = findParetoFront(
        points.map((p) => ({time: p.x, value: p.y, measurement: p.measurement})), metric);
    return {
        front,
        dataset: {
            label: "Pareto front",
            data: front.map((p) => ({x: p.time, y: p.value, measurement: p.measurement})),
            showLine: true,
            stepped: "before",
            borderColor: cssColor("--front"),
            borderWidth: 8,
            pointRadius: 0,
            pointHitRadius: 0,
            order: 10,
        },
    };
}

const tradeoffTooltip = {
    title: ([item]) => nameMeasurement(item.raw.measurement.method, item.raw.measurement.samples),
    label: (item) => {
        const {measurement} = item.raw;
        const time = timeOf(measurement);
        const metrics = results.metrics.map((metric) => `${metric.name}: ` +
            withUnit(formatMetric(metric, metricOf(measurement, metric)), metric.unit));
        return [
            ...metrics,
            `time: ${formatMs(time.median)} ms, quartiles ${formatMs(time.q1)} to ` +
                `${formatMs(time.q3)}, ${measurement.repeats} repeats`,
            ...describeCounters(measurement),
        ];
    },
};

function drawTradeoffChart(theCase, metric) {
    const omitted = [];
    const methods = methodsOf(theCase).filter((method) => !chosen.hidden.has(method.name));
    const sets = methods.map((method) => ({
        label: method.name,
        data: collectPoints(theCase, method.name, metric, omitted),
        showLine: true,
        ...styleOf(method.name),
    }));
    const points = sets.flatMap((set) => set.data);
    const {front, dataset} = makeFrontSet(points, metric);
    const timeName = chosen.time === "frame" ? "Frame time" : "Time of the effect";
    const canvas = byId("tradeoff-chart");
    canvas.setAttribute("aria-label", `${metric.name} against time, case ${theCase.title}; ` +
        "the figures are in the table of all measurements");
    drawChart(canvas, {
        data: {datasets: [...sets, dataset]},
        scales: {
            x: makeAxis(`${timeName}, milliseconds (GPU, logarithmic)`, true,
                points.flatMap((p) => [p.x, p.quartiles[0], p.quartiles[1]])
                    .filter((time) => time > 0)),
            y: makeAxis(describeMetric(metric), false, []),
        },
        tooltip: tradeoffTooltip,
        whiskersAlong: "x",
    });
    byId("tradeoff-omitted").textContent =
        omitted.length > 0 ? `Not drawn: ${omitted.join("; ")}.` : "";
    return front;
}

function drawLegend(theCase) {
    const buttons = methodsOf(theCase).map((method) => {
        const shown = !chosen.hidden.has(method.name);
        return el("button", {
            type: "button",
            "aria-pressed": String(shown),
            "data-method": method.name,
            title: method.title,
            onclick: () => {
                const hidden = new Set(chosen.hidden);
                if (shown) hidden.add(method.name);
                else hidden.delete(method.name);
                choose({hidden});
                document.querySelector(`#tradeoff-legend [data-method="${method.name}"]`).focus();
            },
        }, markIcon(method.name), method.name);
    });
    const key = el("span", {class: "key"}, el("span", {class: "front-key"}), "Pareto front");
    byId("tradeoff-legend").replaceChildren(...buttons, key);
}

function tabulate(measurements) {
    const columns = ["Method", ...["ms", "quartiles", "effect ms"]
        .map((content) => ({content, class: "n"})),
        ...results.metrics.map((m) => ({content: withUnit(m.name, m.unit), class: "n"})),
        "Counters"];
    const rows = measurements.map((m) => {
        const {frame, effect} = m.milliseconds;
        return [
            {content: methodLabel(m.method, m.samples)},
            {content: formatMs(frame.median), class: "n"},
            {content: `${formatMs(frame.q1)} – ${formatMs(frame.q3)}`, class: "n soft"},
            {content: formatMs(effect.median), class: "n"},
            ...results.metrics.map((metric) =>
                ({content: formatMetric(metric, metricOf(m, metric)), class: "n"})),
            {content: describeCounters(m).join("; "), class: "soft small"},
        ];
    });
    return makeTable(columns, rows);
}

function drawTradeoff() {
    const theCase = chosen.case;
    const metric = chosen.metric;
    if (!theCase || !metric || theCase.measurements.length === 0) return;
    reveal("tradeoff");
    const {truth} = theCase;
    byId("tradeoff-note").textContent = `${theCase.title}: ${theCase.description} The truth is ` +
        `${nameMeasurement(truth.method, truth.samples)}. A line joins a method's measurements ` +
        "by its sample counts; the name is at its default. Filled markers trace rays. Whiskers are " +
        "quartiles of time; point at a marker for its figures." + (methodsOf(theCase)
            .some((method) => method.name === truth.method)
            ? ` ${truth.method} made the truth, so it is judged by itself: it is hidden until ` +
                "its name in the legend is pressed." : "");
    drawLegend(theCase);
    const front = drawTradeoffChart(theCase, metric);
    byId("tradeoff-front").replaceChildren(tabulate(front.map((p) => p.measurement)));
    const sorted = [...theCase.measurements].sort((a, b) => timeOf(a).median - timeOf(b).median);
    byId("tradeoff-all").replaceChildren(byId("tradeoff-all").firstElementChild,
        tabulate(sorted));
}
