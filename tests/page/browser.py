"""Headless Chromium, with what the tests ask of it."""

import json
import shutil
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

# WCAG 2.1, "relative luminance" and "contrast ratio", for an element's text colour against the first opaque
# colour behind it.
CONTRAST = """
    const node = document.querySelector(arguments[0]);
    const channels = (color) => color.match(/[0-9.]+/g).map(Number);
    const luminance = (color) => {
        const [r, g, b] = channels(color).map((c) => (c / 255 <= 0.03928 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const style = getComputedStyle(node);
    const isShape = node instanceof SVGElement;
    const ink = isShape ? (style.fill === 'none' ? style.stroke : style.fill) : style.color;
    let behind = isShape ? node.closest('div') : node;
    const isClear = (element) => (channels(getComputedStyle(element).backgroundColor)[3] ?? 1) === 0;
    while (isClear(behind)) {
        behind = behind.parentElement;
    }
    const [x, y] = [luminance(ink), luminance(getComputedStyle(behind).backgroundColor)];
    return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05);
"""


class Browser:
    def __init__(self):
        self.profile = tempfile.mkdtemp(prefix="glint-page-")
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
                         f"--user-data-dir={self.profile}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)

    def quit(self):
        self.driver.quit()
        shutil.rmtree(self.profile, ignore_errors=True)

    def open(self, path, width):
        self.driver.get("about:blank")
        self.console()
        self.requests()
        self.prefer("light")
        self.resize(width)
        self.driver.get(path.as_uri())

    def resize(self, width):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        # Charts are drawn again in the following frame.
        self.driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")

    def prefer(self, scheme):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def console(self):
        """What was logged since the last call."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self):
        """Addresses that were asked for since the last call, images in the page left out."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        addresses = [message["params"]["request"]["url"] for message in messages
                     if message["method"] == "Network.requestWillBeSent"]
        return [address for address in addresses if not address.startswith("data:")]

    def one(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def choose(self, selector, value):
        Select(self.one(selector)).select_by_value(value)

    @staticmethod
    def key(name):
        return getattr(Keys, name)

    def press(self, name):
        ActionChains(self.driver).send_keys(self.key(name)).perform()

    def point_at(self, element):
        self.script("arguments[0].scrollIntoView({block: 'center'})", element)
        ActionChains(self.driver).move_to_element(element).perform()

    def click_at(self, element):
        self.point_at(element)
        ActionChains(self.driver).click().perform()

    def contrast(self, selector):
        return self.script(CONTRAST, selector)
