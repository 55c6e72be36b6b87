// SPDX-License-Identifier: MIT
// What all plots share: theme, logarithmic ticks, quartile whiskers, names beside points.

/** Redraws everything that took its colours from the style sheet. */
const themeListeners = [];

function onTheme(listener) {
    themeListeners.push(listener);
}

function applyTheme() {
    for (const listener of themeListeners) listener();
}

/** Whiskers from q1 to q3 of points that have `quartiles`; `along` is the axis of time. */
const whiskers = {
    id: "whiskers",
    afterDatasetsDraw(chart, _arguments, options) {
        const {ctx, chartArea, scales} = chart;
        const along = options.along === "y" ? "y" : "x";
        ctx.save();
        ctx.beginPath();
        ctx.rect(chartArea.left, chartArea.top, chartArea.width, chartArea.height);
        ctx.clip();
        chart.data.datasets.forEach((dataset, index) => {
            if (!chart.isDatasetVisible(index)) return;
            chart.getDatasetMeta(index).data.forEach((element, i) => {
                const quartiles = dataset.data[i].quartiles;
                if (!quartiles) return;
                const from = scales[along].getPixelForValue(quartiles[0]);
                const to = scales[along].getPixelForValue(quartiles[1]);
                drawWhisker(ctx, along, element, from, to, dataset.borderColor);
            });
        });
        ctx.restore();
    },
};

function drawWhisker(ctx, along, {x, y}, from, to, color) {
    const cap = 4;
    ctx.strokeStyle = color;
    ctx.lineWidth = 1;
    ctx.beginPath();
    const line = (x0, y0, x1, y1) => {
        ctx.moveTo(x0, y0);
        ctx.lineTo(x1, y1);
    };
    if (along === "x") {
        line(from, y, to, y);
        line(from, y - cap, from, y + cap);
        line(to, y - cap, to, y + cap);
    } else {
        line(x, from, x, to);
        line(x - cap, from, x + cap, from);
        line(x - cap, to, x + cap, to);
    }
    ctx.stroke();
}

function overlap(a, b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/** Writes `name` beside the points that have one, where it covers neither points nor names. */
const pointNames = {
    id: "pointNames",
    afterDatasetsDraw(chart) {
        const {ctx, chartArea} = chart;
        const taken = [];
        const named = [];
        chart.data.datasets.forEach((dataset, index) => {
            if (!chart.isDatasetVisible(index)) return;
            chart.getDatasetMeta(index).data.forEach((element, i) => {
                const {x, y} = element;
                if (dataset.pointRadius !== 0)
                    taken.push({left: x - 6, right: x + 6, top: y - 6, bottom: y + 6});
                const name = dataset.data[i].name;
                if (name) named.push({name, x, y, color: dataset.borderColor});
            });
        });
        ctx.save();
        ctx.font = `600 12px ${Chart.defaults.font.family}`;
        ctx.textBaseline = "middle";
        for (const point of named) {
            const box = placeName(point, ctx.measureText(point.name).width, chartArea, taken);
            taken.push(box);
            ctx.lineWidth = 4;
            ctx.strokeStyle = cssColor("--paper");
            ctx.strokeText(point.name, box.left, box.top + 8);
            ctx.fillStyle = point.color;
            ctx.fillText(point.name, box.left, box.top + 8);
        }
        ctx.restore();
    },
};

/** The first place around the point that is free; the first inside the plot when none is. */
function placeName({x, y}, width, area, taken) {
    const gap = 12;
    const places = [
        [x + gap, y - 8], [x - width / 2, y - 26], [x - width - gap, y - 8],
        [x - width / 2, y + gap], [x + gap, y - 24], [x + gap, y + 8],
        [x - width - gap, y - 24], [x - width - gap, y + 8],
        [x - width / 2, y - 42], [x - width / 2, y + 26],
    ].map(([left, top]) => ({left, top, right: left + width, bottom: top + 16}));
    const inside = places.filter((box) => box.left >= area.left && box.right <= area.right &&
        box.top >= area.top && box.bottom <= area.bottom);
    return inside.find((box) => !taken.some((other) => overlap(box, other))) ??
        inside[0] ?? places[0];
}

/** 1, 2 and 5 of each decade, or all nine where the axis spans less than one. */
function isLogTick(value, isShort) {
    const leading = value / 10 ** Math.floor(Math.log10(value) + 1e-9);
    const digits = isShort ? [1, 2, 3, 4, 5, 6, 7, 8, 9] : [1, 2, 5];
    return digits.some((digit) => Math.abs(leading - digit) < 1e-6);
}

function nameLogTick(value) {
    if (value >= 1e6) return `${value / 1e6} M`;
    return value.toLocaleString("en", {maximumSignificantDigits: 3});
}

/**
 * An axis. With `values`, a logarithmic one leaves a little room about them, and a linear one
 * begins at 0; without, a linear one shows the range of the points.
 */
function makeAxis(title, logarithmic, values) {
    const axis = {
        type: logarithmic ? "logarithmic" : "linear",
        title: {display: true, text: title},
        grid: {color: cssColor("--grid"), borderColor: cssColor("--rule")},
        ticks: {},
    };
    if (logarithmic) {
        const isShort = Math.max(...values) < 10 * Math.min(...values);
        axis.ticks = {callback: nameLogTick, autoSkip: true, maxRotation: 0, autoSkipPadding: 12};
        axis.afterBuildTicks = (scale) => {
            scale.ticks = scale.ticks.filter((tick) => isLogTick(tick.value, isShort));
        };
        if (values.length > 0) {
            axis.min = Math.min(...values) * 0.8;
            axis.max = Math.max(...values) * 1.25;
        }
    } else {
        axis.grace = values.length > 0 ? 0 : "8%";
        axis.beginAtZero = values.length > 0;
    }
    return axis;
}

/** Lines and markers of a method. */
function styleOf(methodName) {
    const {color, shape, filled} = markOf(methodName);
    return {
        borderColor: color,
        backgroundColor: color,
        borderWidth: 1.5,
        pointStyle: shape.style,
        pointRotation: shape.rotation,
        pointRadius: 6,
        pointHoverRadius: 8,
        pointBorderWidth: 2,
        pointBorderColor: color,
        pointBackgroundColor: filled ? color : cssColor("--paper"),
        pointHoverBackgroundColor: filled ? color : cssColor("--paper"),
    };
}

/** Draws anew on a canvas: whatever was on it goes. */
function drawChart(canvas, {data, scales, tooltip, whiskersAlong}) {
    Chart.getChart(canvas)?.destroy();
    Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
    Chart.defaults.font.size = 13;
    Chart.defaults.color = cssColor("--ink-soft");
    return new Chart(canvas, {
        type: "scatter",
        data,
        options: {
            animation: false,
            maintainAspectRatio: false,
            interaction: {mode: "nearest", intersect: true},
            layout: {padding: {right: 12}},
            scales,
            plugins: {
                legend: {display: false},
                tooltip: {callbacks: tooltip, displayColors: false},
                whiskers: {along: whiskersAlong},
            },
        },
        plugins: [whiskers, pointNames],
    });
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", applyTheme);
// Paper is white; the plots are drawn for it and drawn back afterwards.
addEventListener("beforeprint", () => {
    document.documentElement.dataset.theme = "light";
    applyTheme();
    for (const chart of Object.values(Chart.instances)) chart.resize();
});
addEventListener("afterprint", () => {
    delete document.documentElement.dataset.theme;
    applyTheme();
});
