// SPDX-License-Identifier: MIT
// Machine, driver, revision, settings, how figures are taken, methods, what was skipped.

function makeFacts(facts) {
    return el("dl", {}, ...facts.filter(([, value]) => value)
        .flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
}

function listFacts() {
    const {machine, device, revision, settings} = results;
    const gib = machine.memoryBytes / 2 ** 30;
    const others = Object.entries(settings).filter(([name]) => !["width", "height"].includes(name))
        .map(([name, value]) => `${name} ${value}`);
    return [
        ["Device", `${device.name}${device.software ? " (software: it runs on the CPU)" : ""}`],
        ["Driver", [device.driver, `Vulkan ${device.api}`, device.rays].filter(Boolean)
            .join(", ")],
        ["Machine", `${machine.cpu}, ${machine.cores} cores, ${formatNumber(gib, 1)} GiB, ` +
            machine.os],
        ["Revision", `${revision.git}${revision.dirty ? " with changes not committed" : ""}`],
        ["Settings", [`${settings.width}×${settings.height}`, ...others].join(", ")],
        ["Taken", `${results.created}, suite ${results.suite}`],
    ];
}

function describeMeasuring() {
    const {pixel, repeats, tonemap} = results.settings;
    const timed = results.sequences
        ? "Each picture is timed once; figures of a film are medians over its frames."
        : `Each figure is the median of ${repeats} repeats unless stated otherwise, ` +
            "and whiskers are quartiles; the methods took turns within the same run.";
    return el("ul", {},
        el("li", {}, "Metrics compare a method's picture with the truth after the same tone map " +
            `for both (${tonemap}), at 8 bits a channel; linear PSNR compares them before it.`),
        el("li", {}, pixel === "box"
            ? "The truth is the mean over each pixel, as a camera sees it."
            : "The truth is taken at the centre of each pixel, as the methods' pictures are."),
        el("li", {}, "Times are GPU times of passes by timestamps. The frame is every pass from " +
            "the G-buffer to the linear blurred picture, without the tone map and the reading " +
            "back; the effect is the frame less the G-buffer."),
        ...(results.sequences ? [el("li", {}, "HDR-FLIP compares the pictures before the tone " +
            "map, at every exposure from the one that shows the brightest light to the one that " +
            "shows the median. That takes long, so only some frames have it.")] : []),
        el("li", {}, timed),
        el("li", {}, "No setting was tuned on the truth that it is judged by."));
}

function makeTruthTable() {
    const rows = results.cases.map((c) => {
        const {check} = c.truth;
        return [c.title, nameMeasurement(c.truth.method, c.truth.samples),
            check ? `${nameMeasurement(check.method, check.samples)}: ` +
                `${formatNumber(check.psnr ?? Number.POSITIVE_INFINITY, 1)} dB` : "–",
            {content: c.truth.hash ?? "–", class: "soft small code"}];
    });
    return makeTable(["Case", "Truth", "Checked against", "Hash"], rows);
}

function makeMethodTable() {
    const rows = results.methods.map((method) => [{content: methodLabel(method.name)},
        method.title, method.publication || "–",
        method.sampleUnit === "none" ? "none" : `${method.sampleUnit}, default ${method.default}`,
        method.usesRays ? "yes" : "no"]);
    return makeTable(["Method", "What it is", "Publication", "Samples", "Rays"], rows);
}

function makeSkippedTable() {
    const rows = results.cases.flatMap((c) => (c.skipped ?? []).map((skipped) =>
        [c.title, {content: methodLabel(skipped.method, skipped.samples)}, skipped.reason]));
    return rows.length > 0 ? makeTable(["Case", "Measurement", "Why"], rows) : null;
}

function drawAbout() {
    reveal("about");
    const skipped = makeSkippedTable();
    byId("about-body").replaceChildren(
        makeFacts(listFacts()),
        el("h3", {}, "How figures are taken"), describeMeasuring(),
        ...(results.cases.length > 0 ? [el("h3", {}, "The truth"), makeTruthTable()] : []),
        el("h3", {}, "The methods"), makeMethodTable(),
        ...(skipped ? [el("h3", {}, "Not measured"), skipped] : []));
}
