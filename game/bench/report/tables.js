// SPDX-License-Identifier: MIT
// Table 1 and Table 2 of the paper as printed, our figures beside them.

function formatPrinted(value, decimals) {
    return value === null || value === undefined ? "–" : formatNumber(value, decimals);
}

/** Similarity to the truth: one row a printed method, then ours that the paper has no row for. */
function makeTable1(table, theCase) {
    const metrics = table.columns.map((id) => metricById.get(id));
    const names = metrics.map((metric) => withUnit(metric.name, metric.unit));
    const columns = ["Paper's method",
        ...names.map((name) => ({content: `${name}, printed`, class: "n"})), "Our method",
        ...names.map((name) => ({content: `${name}, ours`, class: "n"}))];
    const ours = (name) => metrics.map((metric) => {
        const found = name && defaultOf(theCase, name);
        return {content: found ? formatMetric(metric, metricOf(found, metric)) : "–", class: "n"};
    });
    const rows = table.rows.map((row) => [row.name,
        ...row.values.map((value) => ({content: formatPrinted(value, 2), class: "n"})),
        row.ours && defaultOf(theCase, row.ours) ? {content: methodLabel(row.ours)} : "–",
        ...ours(row.ours)]);
    const printed = new Set(table.rows.map((row) => row.ours));
    for (const method of methodsOf(theCase)) {
        if (printed.has(method.name) || !defaultOf(theCase, method.name)) continue;
        rows.push([{content: "not in the paper", class: "absent"}, ...metrics.map(() => ""),
            {content: methodLabel(method.name)}, ...ours(method.name)]);
    }
    return makeTable(columns, rows);
}

/** "hybrid over gather: printed +1.49 dB, ours +1.26 dB" for each row that has a counterpart. */
function listDifferences(table, theCase) {
    const base = table.rows.find((row) => row.name === table.baseline);
    const baseOurs = base?.ours && defaultOf(theCase, base.ours);
    if (!base || !baseOurs) return null;
    const items = table.rows.filter((row) => row !== base && row.ours &&
        defaultOf(theCase, row.ours)).map((row) => {
        const found = defaultOf(theCase, row.ours);
        const parts = table.columns.map((id, i) => {
            const metric = metricById.get(id);
            const printed = formatSigned(row.values[i] - base.values[i], 2);
            const difference = metricOf(found, metric) - metricOf(baseOurs, metric);
            const ours = formatSigned(difference, metric.id === "psnr" ? 2 : 4);
            return `${metric.name} printed ${withUnit(printed, metric.unit)}, ours ` +
                withUnit(ours, metric.unit);
        });
        return el("li", {}, `${row.name} over ${base.name}: ${parts.join("; ")}.`);
    });
    return items.length > 0 ? el("ul", {}, ...items) : null;
}

/** Our milliseconds of a printed pass: the passes that the row names, or all that none does. */
function sumOurPasses(table, row, measurement) {
    if (row.total) return measurement.milliseconds.frame.median;
    const named = new Set(table.rows.flatMap((other) => other.ours ?? []));
    const wanted = (name) => (row.others ? !named.has(name) : (row.ours ?? []).includes(name));
    const passes = measurement.passes.filter((pass) => wanted(pass.name));
    return passes.length > 0
        ? passes.reduce((sum, pass) => sum + pass.median, 0) : Number.NaN;
}

function makeTable2(table, theCase, methodName) {
    const measurement = defaultOf(theCase, methodName);
    const total = table.rows.find((row) => row.total);
    const share = (value, whole) =>
        (Number.isFinite(value) && whole > 0 ? `${formatNumber((value / whole) * 100, 0)} %` : "–");
    const columns = ["Pass",
        ...table.shots.flatMap((shot) => [
            {content: `${shot} CPU`, class: "n soft"}, {content: `${shot} GPU`, class: "n"},
            {content: "share", class: "n soft"}]),
        {content: "ours, GPU", class: "n ours"}, {content: "share", class: "n ours soft"}];
    const rows = table.rows.map((row) => {
        const ours = measurement ? sumOurPasses(table, row, measurement) : Number.NaN;
        const whole = measurement?.milliseconds.frame.median;
        return [{content: row.pass, title: (row.ours ?? []).join(", ")},
            ...table.shots.flatMap((_shot, i) => [
                {content: formatPrinted(row.cpu?.[i], 2), class: "n soft"},
                {content: formatPrinted(row.gpu[i], 2), class: "n"},
                {content: share(row.gpu[i], total?.gpu[i]), class: "n soft"}]),
            {content: formatMs(ours), class: "n ours"},
            {content: share(ours, whole), class: "n ours soft"}];
    });
    if (table.framesPerSecond) {
        const rate = measurement ? 1000 / measurement.milliseconds.frame.median : Number.NaN;
        rows.push(["Frames a second", ...table.framesPerSecond.flatMap((value) => ["",
            {content: formatPrinted(value, 0), class: "n"}, ""]),
            {content: formatNumber(rate, rate < 10 ? 2 : 0), class: "n ours"},
            {content: "", class: "ours"}]);
    }
    return makeTable(columns, rows, {class: "printed"});
}

function drawTables() {
    const {paper} = results;
    const theCase = results.cases.find((c) => c.name === paper?.case) ?? results.cases[0];
    if (!paper || !theCase) return;
    const parts = [];
    if (paper.table1) {
        parts.push(el("h3", {}, "Table 1: similarity to the truth"),
            makeTable1(paper.table1, theCase));
        const differences = listDifferences(paper.table1, theCase);
        if (differences) parts.push(differences);
    }
    if (paper.table2) {
        const where = `Printed: ${paper.table2.device}. Ours: ${results.device.name}, ` +
            `${results.settings.width}×${results.settings.height}, ${paper.method}; a pass is ` +
            "the sum of the medians of what it stands for here (point at its name). Shares of " +
            "the whole compare devices that milliseconds do not.";
        parts.push(el("h3", {}, "Table 2: milliseconds a pass"), el("p", {}, where),
            makeTable2(paper.table2, theCase, paper.method));
    }
    if (paper.findings?.length > 0) {
        parts.push(el("h3", {}, "Why ours lands where it does"),
            el("ul", {}, ...paper.findings.map((text) => el("li", {}, text))));
    }
    if (parts.length === 0) return;
    reveal("tables");
    byId("tables-source").textContent = `Printed in ${paper.source}. Ours: case ${theCase.title}.`;
    byId("tables-body").replaceChildren(...parts);
}
