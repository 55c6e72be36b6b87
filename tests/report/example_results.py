# SPDX-License-Identifier: MIT
"""Synthetic results of each suite for the report's tests: no figure here was measured.

Pictures and figures come from formulas, so that a test knows them and nothing has to be kept. Run
by hand, `example_results.py SUITE FOLDER` writes results.json and its pictures for inspection.
"""

import json
import math
import pathlib
import struct
import subprocess
import sys
import zlib

WIDTH, HEIGHT = 160, 90

SUITES = ("paper", "hard", "scaling", "sequence")
FRAMES = 24

# name, title, publication, sample unit, default, rays, sample counts n, ms = a + b * n,
# psnr = p + g * log2(n)
METHODS = [
    ("sharp", "No motion blur", "", "none", None, False, [None], (100, 0), (22.0, 0)),
    ("own_velocity", "Samples along the pixel's own motion", "", "samples", 15, False,
     [4, 8, 15, 32, 64], (104, 1.1), (24.5, 0.3)),
    ("mcguire2012", "Gather over the dominant motion of the tiles around",
     "McGuire, Hennessy, Bukowski, Osman 2012", "samples", 15, False,
     [4, 8, 15, 32, 64], (115, 1.9), (27.0, 0.4)),
    ("guertin2014", "A second direction, variance-weighted tiles",
     "Guertin, McGuire, Nowrouzezahrai 2014", "samples", 15, False,
     [4, 8, 15, 32, 64], (118, 2.3), (27.8, 0.5)),
    ("jimenez2014", "Scatter as you gather", "Jimenez 2014", "samples", 15, False,
     [4, 8, 15, 32, 64], (117, 2.1), (28.3, 0.4)),
    ("gather", "The paper's post-process", "Tan, Cui, Bhojan", "samples", 15, False,
     [4, 8, 15, 32, 64], (116, 2.0), (28.6, 0.4)),
    ("hybrid", "Gather with ray-traced background", "Tan, Cui, Bhojan", "samples", 15, True,
     [4, 8, 15, 32, 64], (180, 2.2), (30.0, 0.4)),
    ("denoised", "One ray per pixel, filtered", "Oberberger 2022", "rays", 1, True,
     [1, 2, 4], (260, 130), (30.5, 1.2)),
    ("accumulate", "Mean of sharp frames", "Haeberli, Akeley 1990", "instants", 16, False,
     [1, 4, 16, 64], (3, 97), (22.0, 3.6)),
    ("truth", "Distributed ray tracing", "Cook, Porter, Carpenter 1984", "rays", 16, True,
     [1, 2, 4, 16, 64, 256], (8, 150), (18.0, 3.1)),
]

CASES = ["translation", "spin", "wheel with spokes", "camera pan", "dolly", "orbit",
         "two crossing movers of one colour", "static post before a mover",
         "concave self-overlap", "motion longer than a tile", "thin geometry", "sky and horizon"]

# As printed: Table 1 and Table 2 of the paper; CPU and GPU milliseconds of its three shots.
PAPER = {
    "source": "Tan, Cui, Bhojan: Hybrid MBlur",
    "case": "vase",
    "method": "hybrid",
    "table1": {
        "columns": ["psnr", "ssim"],
        "baseline": "Adapted Post-Process",
        "rows": [
            {"name": "Adapted Post-Process", "values": [24.20, 0.91], "ours": "gather"},
            {"name": "UE4 Post-Process", "values": [12.32, 0.68]},
            {"name": "Hybrid MBlur", "values": [25.69, 0.92], "ours": "hybrid"},
        ],
    },
    "table2": {
        "device": "NVIDIA GeForce RTX 2080 Ti, Intel Core i7-8700K",
        "shots": ["PR", "ST", "BI"],
        "rows": [
            {"pass": "G-Buffer", "cpu": [0.26, 0.54, 1.74], "gpu": [1.19, 3.54, 6.43],
             "ours": ["G-buffer"]},
            {"pass": "Ray Mask", "cpu": [0.05, 0.05, 0.06], "gpu": [0.33, 0.38, 0.33],
             "ours": ["edge", "ray mask"]},
            {"pass": "Ray Trace", "cpu": [1.13, 2.27, 2.99], "gpu": [0.59, 0.65, 0.62],
             "ours": ["ray reveal"]},
            {"pass": "Tile-Dilate", "cpu": [0.05, 0.06, 0.08], "gpu": [1.48, 1.44, 1.43],
             "ours": ["tile max", "neighbour max"]},
            {"pass": "PP-Composite", "cpu": [0.03, 0.04, 0.04], "gpu": [0.85, 0.82, 0.82],
             "ours": ["gather and composite"]},
            {"pass": "Others", "cpu": [3.14, 4.67, 3.48], "gpu": [0.39, 0.42, 0.29],
             "others": True},
            {"pass": "Total Duration", "cpu": [4.66, 7.63, 8.39], "gpu": [4.83, 7.25, 9.92],
             "total": True},
        ],
        "framesPerSecond": [205, 148, 112],
    },
    "findings": ["These figures are synthetic: they show the page, not the method."],
}


def png(pixels):
    """An 8-bit RGB PNG of rows of (r, g, b) in 0 to 1."""
    raw = b"".join(b"\0" + bytes(max(0, min(255, round(c * 255))) for pixel in row for c in pixel)
                   for row in pixels)

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 6)) +
            chunk(b"IEND", b""))


def coverage(x, y, blur):
    """How much of the exposure a disc that moved by `blur` pixels to the right covers a pixel."""
    half = math.sqrt(max(0.0, 28.0 ** 2 - (y - 45.0) ** 2))
    if half == 0:
        return 0.0
    left, right = x - (80 - half), x - (80 + half)
    if blur <= 0:
        return 1.0 if left >= 0 > right else 0.0
    clamp = lambda v: max(0.0, min(1.0, v))
    return clamp(left / blur + 0.5) - clamp(right / blur + 0.5)


def picture_rows(blur, error):
    """A red disc before stripes; `error` of 0 to 1 puts a fixed pattern over it."""
    rows = []
    for y in range(HEIGHT):
        row = []
        for x in range(WIDTH):
            a = coverage(x, y, blur)
            stripe = 0.85 if (x + y) // 10 % 2 else 0.55
            noise = error * (((x * 7919 + y * 104729 + x * y * 31) % 97) / 97 - 0.5)
            row.append(tuple(a * disc + (1 - a) * stripe * tint + noise
                             for disc, tint in zip((0.75, 0.12, 0.1), (0.95, 0.9, 0.8))))
        rows.append(row)
    return rows


def error_values(error):
    return [[error * 4 * abs(coverage(x, y, 24) - coverage(x, y, 0)) for x in range(WIDTH)]
            for y in range(HEIGHT)]


def error_map(errors):
    return png([[(min(1, v * 2.2), max(0, v * 1.6 - 0.5), 0.25 * v + 0.02) for v in row]
                for row in errors])


def quartiles(value, spread=0.02):
    return {"median": round(value, 4), "q1": round(value * (1 - spread), 4),
            "q3": round(value * (1 + 1.5 * spread), 4)}


def passes_of(name, frame):
    base = min(frame, 95.0)
    passes = [{"name": "G-buffer", "effect": False, **quartiles(base)}]
    rest = frame - base
    shares = {"hybrid": [("tile max", .02), ("neighbour max", .01), ("edge", .07),
                         ("ray mask", .06), ("ray reveal", .64), ("gather and composite", .19),
                         ("read ray mask counters", .01)]}
    for label, share in shares.get(name, [("blur", 1.0)] if rest > 0 else []):
        passes.append({"name": label, "effect": True, **quartiles(rest * share)})
    return passes


def measurement(method, samples, case, index, keep_pictures):
    name, _, _, _, default, _, _, (a, b), (p, g) = method
    shift = 1.7 * math.sin(index * 1.9 + len(name) * 2.3) if index else 0.0
    frame = (a + b * (samples or 0)) * (1 + 0.25 * math.sin(index))
    psnr = p + g * math.log2(samples or 1) + shift
    result = {
        "method": name, "samples": samples, "isDefault": samples == default, "repeats": 7,
        "metrics": {"psnr": round(psnr, 3), "ssim": round(1 - 0.9 * 10 ** (-psnr / 18), 5),
                    "flip": round(0.9 * 10 ** (-psnr / 20), 5)},
        "milliseconds": {"frame": quartiles(frame), "effect": quartiles(max(0.0, frame - 95)),
                         "wall": quartiles(frame + 7)},
        "passes": passes_of(name, frame),
        "counters": {"rays traced": int(6720 * (1 + 0.1 * index))} if name == "hybrid" else {},
    }
    if name == "sharp":
        result["milliseconds"]["effect"] = {"median": 0, "q1": 0, "q3": 0}
    if keep_pictures and samples == default:
        stem = f"images/{case}.{name}"
        result["image"], result["errorMap"] = f"{stem}.png", f"{stem}.error.png"
    return result


def make_case(name, title, index, methods, keep_pictures):
    skipped = [{"method": "truth", "samples": 256,
                "reason": "predicted 300 s, above the limit of 60 s"}]
    return {
        "name": name, "title": title,
        "description": f"a synthetic disc moves before stripes ({title}).",
        "time": 0, "exposure": 1 / 60, "phase": "end", "camera": "main",
        "antiAliasing": "none",
        "truth": {"method": "accumulate", "samples": 256, "hash": "synthetic",
                  **({"image": f"images/{name}.reference.png"}
                     if keep_pictures else {}),
                  "check": {"method": "truth", "samples": 64, "psnr": 46.1}},
        "crops": [{"x": 40, "y": 20, "width": 32, "height": 24, "label": "trailing edge"},
                  {"x": 92, "y": 30, "width": 32, "height": 24, "label": "leading edge"}],
        "measurements": [measurement(m, samples, name, index, keep_pictures)
                         for m in methods for samples in m[6] if (m[0], samples) != ("truth", 256)],
        "skipped": skipped if any(m[0] == "truth" for m in methods) else [],
    }


def equal_time(case):
    reference = next(m for m in case["measurements"] if m["method"] == "hybrid" and m["isDefault"])
    wanted = reference["milliseconds"]["frame"]["median"]
    rows = []
    for name in dict.fromkeys(m["method"] for m in case["measurements"]):
        own = [m for m in case["measurements"] if m["method"] == name]
        best = min(own, key=lambda m: abs(math.log(m["milliseconds"]["frame"]["median"] / wanted)))
        row = {"method": name, "samples": best["samples"], "metrics": best["metrics"],
               "milliseconds": best["milliseconds"]["frame"]["median"]}
        if "image" in best:
            row["image"] = best["image"]
        rows.append(row)
    return {"case": case["name"], "rows": rows,
            "reference": {"method": "hybrid", "samples": reference["samples"], "milliseconds": wanted}}


def scaling_axis(axis, title, unit, values, labels, exponents):
    series = []
    for name, exponent, factor in exponents:
        points = []
        for value, label in zip(values, labels):
            grown = (value / values[-1]) ** exponent if exponent else 1 + value / 100
            points.append({"value": value, "label": label,
                           "milliseconds": {"frame": quartiles(factor * grown, 0.05),
                                            "effect": quartiles(0.4 * factor * grown, 0.05),
                                            "wall": quartiles(1.1 * factor * grown, 0.05)}})
        entry = {"method": name, "points": points}
        if exponent:
            fit = {"exponent": exponent, "r2": 0.999, "from": values[1], "to": values[-1]}
            entry["fit"] = {"frame": fit, "effect": {**fit, "r2": 0.998}}
        series.append(entry)
    return {"axis": axis, "title": title, "unit": unit, "series": series}


def scaling():
    sizes = [(640, 360), (1280, 720), (1920, 1080), (3840, 2160)]
    pixels, names = [w * h for w, h in sizes], [f"{w}x{h}" for w, h in sizes]
    return [
        scaling_axis("resolution", "Resolution", "pixels", pixels, names,
                     [("gather", 0.97, 4100), ("hybrid", 0.95, 7300), ("truth", 1.0, 61000)]),
        scaling_axis("entities", "Entities", "entities", [1, 10, 100, 1000, 10000],
                     ["1", "10", "100", "1000", "10000"],
                     [("gather", 0.1, 240), ("hybrid", 0.31, 900)]),
        scaling_axis("moving", "Share of the picture that moves", "percent", [0, 25, 50, 100],
                     ["0 %", "25 %", "50 %", "100 %"],
                     [("gather", None, 180), ("hybrid", None, 320)]),
    ]


TEMPORAL = [("psnr", "PSNR", "dB", "higher"), ("ssim", "SSIM", "", "higher"),
            ("flip", "FLIP", "", "lower"), ("hdrFlip", "HDR-FLIP", "", "lower"),
            ("flicker", "Flicker", "", "lower"),
            ("standingFlicker", "Flicker, camera at rest", "", "lower"),
            ("fixedNoise", "Fixed noise", "", "lower")]


def gray_of(frame):
    """Of a film's frame: so far from the next that no encoder confuses them."""
    return 40 + 6 * frame


def make_film(file, stripe):
    """Frames that encode their number as grey; a column of the film's own `stripe`."""
    colour = bytes(round(255 * value) for value in stripe)
    rows = [b"".join(colour if 8 <= x < 24 else bytes([gray_of(i)] * 3) for x in range(WIDTH))
            for i in range(FRAMES)]
    subprocess.run(
        ["ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24",
         "-s", f"{WIDTH}x{HEIGHT}", "-framerate", "24", "-i", "-", "-c:v", "libvpx-vp9", "-crf", "12",
         "-b:v", "0", "-g", "8", "-deadline", "realtime", "-cpu-used", "8", "-pix_fmt", "yuv420p", file],
        input=b"".join(row * HEIGHT for row in rows), check=True)


def sequence(name, shift):
    measurements = []
    for method, samples, ms, psnr in (("sharp", None, 20, 24), ("gather", 15, 25, 30),
                                      ("resolved", 15, 30, 42)):
        curve = lambda value: [round(value + 0.1 * math.sin(i + shift), 4) for i in range(FRAMES)]
        flicker = round(0.5 / psnr ** 2, 6)
        measurements.append({
            "method": method, "samples": samples,
            "metrics": {"psnr": psnr + shift, "ssim": 0.9 + psnr / 1000, "flip": 0.5 / psnr,
                        "hdrFlip": 0.6 / psnr, "flicker": flicker, "standingFlicker": flicker / 4,
                        "fixedNoise": flicker / 2},
            "milliseconds": {"frame": quartiles(ms), "effect": quartiles(ms - 20),
                             "wall": quartiles(ms + 5)},
            "curves": {"psnr": curve(psnr), "ssim": curve(0.9), "flip": curve(0.2),
                       "hdrFlip": [value if i % 4 == 0 else None
                                   for i, value in enumerate(curve(0.25))],
                       "flicker": [None] + curve(0.3)[1:]},
            "film": f"films/{name}.{method}.webm"})
    rows = lambda times: [{"method": m["method"], "samples": m["samples"] if time else None,
                           "milliseconds": time, "psnr": m["metrics"]["psnr"]}
                          for m, time in zip(measurements, times)]
    return {
        "name": name, "title": f"Title of {name}", "description": "A synthetic sequence.",
        "kind": "flight", "antiAliasing": "none", "frames": FRAMES, "framesPerSecond": 24, "standingFrames": 6,
        "truth": {"method": "accumulate", "maxStepPx": 1, "mostInstants": 256,
                  "instants": quartiles(20),
                  "film": f"films/{name}.truth.webm"},
        "measurements": measurements,
        "equalError": [{"psnr": 35, "frames": [3, 9], "rows": rows([None, 28, 18])},
                       {"psnr": 40, "frames": [3, 9], "rows": rows([None, None, 30])}],
        "skipped": [],
    }


def make(suite):
    """Results of a suite: "paper" has one case with pictures, "hard" twelve, the others none."""
    methods = METHODS
    if suite == "paper":
        cases = [make_case("vase", "Vase before a cushion", 0, methods, True)]
    elif suite == "hard":
        cases = [make_case(f"case{i}", title, i, methods, i == 0)
                 for i, title in enumerate(CASES)]
    else:
        cases = []
    results = {
        "schema": "shutter-bench", "version": 2, "suite": suite,
        "created": "2026-01-01T00:00:00Z", "complete": suite != "hard",
        "options": [f"--suite {suite}", f"--size {WIDTH}x{HEIGHT}"],
        "revision": {"git": "abc1234", "dirty": suite == "hard"},
        "machine": {"cpu": "synthetic CPU", "cores": 2, "memoryBytes": 8 << 30,
                    "os": "synthetic OS"},
        "device": {"name": "synthetic device", "driver": "none",
                   "rays": "no rays </script>", "api": "1.3.0", "software": True},
        "settings": {"width": WIDTH, "height": HEIGHT, "repeats": 7, "pixel": "centre",
                     "tonemap": "neutral"},
        "metrics": [
            {"id": "psnr", "name": "PSNR", "unit": "dB", "better": "higher"},
            {"id": "ssim", "name": "SSIM", "unit": "", "better": "higher"},
            {"id": "flip", "name": "FLIP", "unit": "", "better": "lower"},
        ],
        "methods": [{"name": m[0], "title": m[1], "publication": m[2], "sampleUnit": m[3],
                     "default": m[4], "usesRays": m[5]} for m in methods],
        "headline": {"method": "hybrid", "baseline": "gather"},
        "cases": cases,
    }
    if suite in ("paper", "hard"):
        results["equalTime"] = [equal_time(case) for case in cases]
    if suite == "paper":
        results["paper"] = PAPER
    if suite == "scaling":
        results["scaling"] = scaling()
    if suite == "sequence":
        results["methods"].append(
            {"name": "resolved", "title": "What the pixel saw", "publication": "",
             "sampleUnit": "instants", "default": 15, "usesRays": False})
        results["headline"] = {"method": "resolved", "baseline": "gather"}
        results["temporalMetrics"] = [dict(zip(("id", "name", "unit", "better"), row))
                                      for row in TEMPORAL]
        results["sequences"] = [sequence(name, i) for i, name in enumerate(("first", "second"))]
    return results


def write(suite, folder):
    """Writes results.json and every picture that it names; returns the results."""
    folder = pathlib.Path(folder)
    (folder / "images").mkdir(parents=True, exist_ok=True)
    results = make(suite)
    (folder / "results.json").write_text(json.dumps(results), encoding="utf-8")
    for number, film in enumerate(results.get("sequences", [])):
        (folder / "films").mkdir(exist_ok=True)
        for i, entry in enumerate([film["truth"], *film["measurements"]]):
            make_film(folder / entry["film"], (0.2 * i, 1 - 0.2 * i, 0.5 * number))
    for case in results["cases"]:
        if "image" in case["truth"]:
            truth = picture_rows(24, 0)
            (folder / case["truth"]["image"]).write_bytes(png(truth))
        for m in case["measurements"]:
            if "image" not in m:
                continue
            error = 10 ** ((22 - m["metrics"]["psnr"]) / 20)
            blur = 0 if m["method"] == "sharp" else 24 * (1 - error / 2)
            rows, errors = picture_rows(blur, error / 4), error_values(error)
            (folder / m["image"]).write_bytes(png(rows))
            (folder / m["errorMap"]).write_bytes(error_map(errors))
    return results


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in SUITES:
        sys.exit(f"usage: example_results.py {'|'.join(SUITES)} FOLDER")
    write(sys.argv[1], sys.argv[2])
