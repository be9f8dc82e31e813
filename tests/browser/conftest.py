"""A small finished run with its pages, and a browser that records console messages and requests."""

import json
import time
from importlib.util import find_spec

import pytest
from project import Project

# `make extras` installs selenium; `make test` skips these tests without it
collect_ignore_glob = [] if find_spec("selenium") else ["test_*.py"]

CHROMIUM, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"
FLAGS = """--headless=new --no-sandbox --disable-gpu --disable-quic --no-first-run
--disable-background-networking --disable-component-update --disable-sync
--window-size=1400,1000""".split()
LOCAL = ("file:", "data:", "blob:")
SECONDS = 20
SWEEP = {"r": ["0.9", "0.8"], "beta": ["-0.5", "0", "0.5"], "seeds": 2}
TARGETS = ("figures", "explore", "results/tiny/report.html")


class Browser:
    """A page in a browser."""

    def __init__(self, driver):
        self.driver = driver

    def open(self, path, fragment=""):
        """Load a file, and clear the records of console messages and requests."""
        self.driver.get("about:blank")
        self.complaints(), self.requests()
        self.driver.get(f"{path.as_uri()}{fragment}")

    def find(self, selector):
        """Return the elements that match a CSS selector."""
        return self.driver.find_elements("css selector", selector)

    def text(self, selector):
        (element,) = self.find(selector)
        return element.text

    def script(self, source, *arguments):
        return self.driver.execute_script(source, *arguments)

    def wait(self, condition):
        """Return the result of `condition` as soon as it is true; fail after SECONDS."""
        deadline = time.monotonic() + SECONDS
        while not (result := condition()):
            assert time.monotonic() < deadline
            time.sleep(0.05)
        return result

    def complaints(self):
        """Return the warnings and errors in the console since the last call."""
        log = self.driver.get_log("browser")
        return [entry["message"] for entry in log if entry["level"] in ("WARNING", "SEVERE")]

    def requests(self):
        """Return the addresses requested since the last call, except for those in the file."""
        log = [
            json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")
        ]
        parameters = [
            entry["params"] for entry in log if entry["method"] == "Network.requestWillBeSent"
        ]
        urls = [entry["request"]["url"] for entry in parameters]
        return [url for url in urls if not url.startswith(LOCAL)]


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for flag in (*FLAGS, f"--user-data-dir={tmp_path_factory.mktemp('browser')}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options, webdriver.ChromeService(DRIVER))
    yield Browser(driver)
    driver.quit()


@pytest.fixture(scope="session")
def finished_run(tmp_path_factory):
    """A project with a finished run at a tiny scale, two r and three beta, and its report."""
    project = Project(tmp_path_factory.mktemp("browsed"))

    def change(config):
        tiny = config["scales"]["tiny"]
        for name in ("vibrated", "sheared", "cooling"):
            tiny[name]["sweep"] = SWEEP

    project.configure(change)
    project.succeed("-j2", "--config", "scale=tiny", "--", *TARGETS)
    project.succeed("--config", "scale=tiny", "--report", "report.html", "--", *TARGETS)
    return project
