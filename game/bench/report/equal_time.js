// SPDX-License-Identifier: MIT
// What each rival reaches in the time that the reference method takes.

/** By what makeViewport() paints a crop of a default's picture; null where that is not shown. */
function makeExact(theCase, image) {
    const picture = picturesOf(theCase).find((shown) => shown.image === image);
    return picture ? {picture, theCase, mode: "picture"} : null;
}

function makeEqualTimeRow(theCase, reference, row, base) {
    const crop = theCase.crops?.[0];
    const isReference = row.method === reference.method && row.samples === reference.samples;
    const cells = results.metrics.flatMap((metric) => {
        const value = metricOf(row, metric);
        const cell = {content: formatMetric(metric, value), class: "n"};
        if (metric !== chosen.metric) return [cell];
        const decimals = kDecimals[metric.id] ?? 3;
        const difference = value - metricOf(base, metric);
        const text = isReference ? "" :
            Number.isFinite(difference) ? formatSigned(difference, decimals) : "–";
        const side = difference === 0 ? "" : isBetter(metric, difference, 0) ? "better" : "worse";
        return [cell, {content: text, class: `n ${isReference ? "" : side}`}];
    });
    return [
        {content: methodLabel(row.method, row.samples), class: isReference ? "reference" : ""},
        {content: formatMs(row.milliseconds), class: "n"},
        {content: formatRatio(row.milliseconds / reference.milliseconds), class: "n soft"},
        ...cells,
        {content: row.image && crop
            ? makeViewport(row.image, crop, `${row.method}, ${crop.label}`,
                makeExact(theCase, row.image)) : "", class: "thumb"},
    ];
}

/** How near the best rival comes, in a sentence. */
function describeClosest(reference, rows, base) {
    const metric = chosen.metric;
    const [closest] = rows.filter((row) =>
        row.method !== reference.method && !truthMethods.has(row.method));
    if (!closest) return "";
    const value = metricOf(closest, metric);
    const gained = gain(metric, value, metricOf(base, metric));
    if (!Number.isFinite(gained)) return "";
    return ` The best rival is ${nameMeasurement(closest.method, closest.samples)}: ` +
        `${formatMetric(metric, Math.abs(gained))} ${metric.unit || metric.name} ` +
        `${gained > 0 ? "better" : "worse"} than ${reference.method}.`;
}

function drawEqualTime() {
    const entry = results.equalTime?.find((e) => e.case === chosen.case?.name);
    byId("equal-time").hidden = !entry;
    if (!entry) return;
    const {reference} = entry;
    const theCase = chosen.case;
    const base = theCase.measurements.find((m) =>
        m.method === reference.method && m.samples === reference.samples);
    if (!base) throw new Error(`equalTime of ${entry.case}: its reference was not measured`);
    const own = {...reference, metrics: base.metrics, image: base.image};
    const rows = [own, ...entry.rows.filter((row) =>
        row.method !== reference.method || row.samples !== reference.samples)];
    rows.sort((a, b) =>
        gain(chosen.metric, metricOf(b, chosen.metric), metricOf(a, chosen.metric)) || 0);
    byId("equal-time-note").textContent = `${theCase.title}: every method's sample count is ` +
        `chosen so that it takes the frame time of ${nameMeasurement(reference.method, reference.samples)}, ` +
        `${formatMs(reference.milliseconds)} ms, as nearly as sample counts allow; best first. A ` +
        "method without samples, or that cannot be so slow or so fast, is listed with its nearest." +
        describeClosest(reference, rows, base);
    const columns = ["Method", {content: "ms", class: "n"},
        {content: "of the time", class: "n"},
        ...results.metrics.flatMap((metric) => {
            const cell = {content: withUnit(metric.name, metric.unit), class: "n"};
            return metric === chosen.metric
                ? [cell, {content: `against ${reference.method}`, class: "n"}] : [cell];
        }), theCase.crops?.[0]?.label ?? ""];
    byId("equal-time-table").replaceChildren(makeTable(columns,
        rows.map((row) => makeEqualTimeRow(theCase, reference, row, base)),
        {class: "equal-time"}));
}
