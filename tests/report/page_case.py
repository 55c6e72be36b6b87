# SPDX-License-Identifier: MIT
"""What tests of the report page share: a browser without network, pages of synthetic results."""

import atexit
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import example_results

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError:
    print("skipped: the package python3-selenium is missing")
    sys.exit(77)

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
DRIVER = shutil.which("chromedriver")
if not CHROMIUM or not DRIVER:
    print("skipped: the packages chromium and chromium-driver are missing")
    sys.exit(77)

if not shutil.which("ffmpeg"):
    print("skipped: the package ffmpeg is missing")
    sys.exit(77)

MAKE_PAGE = [os.environ["SHUTTER_TEST_FILES"], "page"]
check = subprocess.run([*MAKE_PAGE, "nowhere"], stderr=subprocess.PIPE, text=True, check=False)
if check.returncode == 77:
    print(f"skipped: {check.stderr}")
    sys.exit(77)

CHART = "return Chart.getChart(document.querySelector(arguments[0])).data.datasets"
DATASETS = CHART + ".map((set) => ({label: set.label, data: set.data.map(({x, y}) => [x, y])}))"


def start_browser(profile):
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    # Containers run the tests as root and have little /dev/shm.
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1280,900", f"--user-data-dir={profile}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=webdriver.chrome.service.Service(DRIVER), options=options)


class PageCase(unittest.TestCase):
    """One browser, and one page of each suite, for all classes of a program."""

    browser = None

    @classmethod
    def setUpClass(cls):
        if PageCase.browser:
            return
        stack = contextlib.ExitStack()
        atexit.register(stack.close)
        PageCase.folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        PageCase.results = {}
        for suite in example_results.SUITES:
            PageCase.results[suite] = example_results.write(suite, cls.folder / suite)
            subprocess.run([*MAKE_PAGE, cls.folder / suite], check=True)
            # The page must be self-contained.
            (cls.folder / suite / "results.json").unlink()
            shutil.rmtree(cls.folder / suite / "images")
            shutil.rmtree(cls.folder / suite / "films", ignore_errors=True)
        PageCase.browser = start_browser(cls.folder / "profile")
        stack.callback(cls.browser.quit)
        cls.browser.execute_cdp_cmd("Network.enable", {})
        cls.browser.execute_cdp_cmd("Network.emulateNetworkConditions", {
            "offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})

    def open(self, suite, width=1280, theme="light", media="screen", ready=True):
        """A fresh page in a window so wide and in the reader's theme; not `ready`: it will fail."""
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "media": media, "features": [{"name": "prefers-color-scheme", "value": theme}]})
        self.browser.get((self.folder / suite / "index.html").as_uri())
        if not ready:
            return
        WebDriverWait(self.browser, 60).until(lambda browser: browser.execute_script(
            "return document.documentElement.dataset.ready === 'true' &&"
            " [...document.images].every((image) => image.complete)"))

    def tearDown(self):
        self.assertEqual(self.browser.get_log("browser"), [])

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def find_all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def js(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def datasets(self, canvas="#tradeoff-chart"):
        return {d["label"]: d["data"] for d in self.js(DATASETS, canvas)}

    def choose(self, selector, value):
        Select(self.find(selector)).select_by_value(value)
