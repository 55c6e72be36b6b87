// SPDX-License-Identifier: MIT
// Time against resolution, entities and the like, with fitted power laws.

/** Factor c of c·x^exponent through the points of the fit's range (least squares of logarithms). */
function findFactor(points, fit) {
    const inside = points.filter((p) => p.x >= fit.from && p.x <= fit.to);
    const sum = inside.reduce((s, p) => s + Math.log(p.y) - fit.exponent * Math.log(p.x), 0);
    return Math.exp(sum / inside.length);
}

function makeScalingSets(axis, logarithmic) {
    return axis.series.flatMap((series) => {
        const points = series.points.map((p, i) => ({
            x: p.value, y: timeOf(p).median, label: p.label, method: series.method,
            quartiles: [timeOf(p).q1, timeOf(p).q3],
            name: i === series.points.length - 1 ? series.method : undefined,
        }));
        const sets = [{label: series.method, data: points, showLine: true,
            ...styleOf(series.method)}];
        const fit = series.fit?.[chosen.time];
        if (fit && logarithmic) {
            const factor = findFactor(points, fit);
            sets.push({
                label: `${series.method}, fit`,
                data: [fit.from, fit.to].map((x) => ({x, y: factor * x ** fit.exponent})),
                showLine: true, pointRadius: 0, pointHitRadius: 0, borderWidth: 1.5,
                borderDash: [3, 5], borderColor: cssColor("--ink-soft"),
            });
        }
        return sets;
    });
}

function titleOf({title, unit}) {
    return !unit || unit === title.toLowerCase() ? title : `${title} (${unit})`;
}

function drawScalingChart(canvas, axis) {
    const points = axis.series.flatMap((series) => series.points);
    const times = points.flatMap((p) => Object.values(timeOf(p)));
    const values = points.map((p) => p.value);
    const logarithmic = [...values, ...times].every((value) => value > 0);
    canvas.setAttribute("aria-label", `Time against ${axis.title}; the figures are in the table`);
    drawChart(canvas, {
        data: {datasets: makeScalingSets(axis, logarithmic)},
        scales: {
            x: makeAxis(titleOf(axis), logarithmic, values),
            y: makeAxis(`${chosen.time === "frame" ? "Frame" : "Effect"} time, milliseconds`, logarithmic, times),
        },
        tooltip: {
            title: ([item]) => `${item.raw.method}, ${item.raw.label}`,
            label: (item) => `${formatMs(item.raw.y)} ms, quartiles ` +
                `${formatMs(item.raw.quartiles[0])} to ${formatMs(item.raw.quartiles[1])}`,
        },
        whiskersAlong: "y",
    });
}

function makeScalingTable(axis) {
    const labels = [...new Map(axis.series.flatMap((series) => series.points)
        .sort((a, b) => a.value - b.value).map((p) => [p.value, p.label]))];
    const columns = ["Method", ...labels.map(([, label]) => ({content: label, class: "n"})),
        {content: "exponent", class: "n"}, {content: "r²", class: "n"}, "fitted over"];
    const rows = axis.series.map((series) => {
        const fit = series.fit?.[chosen.time];
        return [{content: methodLabel(series.method)},
        ...labels.map(([value]) => {
            const found = series.points.find((p) => p.value === value);
            return {content: found ? formatMs(timeOf(found).median) : "–", class: "n"};
        }),
        {content: fit ? formatNumber(fit.exponent, 2) : "–", class: "n"},
        {content: fit ? formatNumber(fit.r2, 3) : "–", class: "n"},
        {content: fit ? `${formatNumber(fit.from, 0)} to ${formatNumber(fit.to, 0)}` : "–",
            class: "soft"}];
    });
    return makeTable(columns, rows);
}

function drawScaling() {
    const axes = (results.scaling ?? []).filter((axis) => axis.series.length > 0);
    if (axes.length === 0) return;
    reveal("scaling");
    byId("scaling-plots").replaceChildren(...axes.map((axis) => el("div", {},
        el("h3", {}, axis.title),
        el("div", {class: "plot"},
            el("canvas", {role: "img", id: `scaling-${axis.axis}`})),
        makeScalingTable(axis))));
    for (const axis of axes) drawScalingChart(byId(`scaling-${axis.axis}`), axis);
}
