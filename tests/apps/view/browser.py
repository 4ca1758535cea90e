"""Headless Chromium by Selenium. Needs the system's Python (/usr/bin/python3), as python3-selenium does."""

import os
import shutil

try:
    from selenium import webdriver
except ImportError:
    webdriver = None

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
NEEDED = "chromium, chromium-driver and python3-selenium (apt-get install them)"


def is_there():
    return bool(webdriver and CHROMIUM and DRIVER)


def start(downloads):
    """A window of 1400 by 900 pixels, which keeps its messages for get_log(). `downloads`: the folder for saved files."""
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for flag in ("--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--force-color-profile=srgb", "--hide-scrollbars",
                 "--window-size=1400,900"):
        options.add_argument(flag)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")
    options.add_experimental_option("prefs", {"download.default_directory": downloads})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=webdriver.chrome.service.Service(DRIVER), options=options)


def resize(driver, width, height, scale):
    """`scale`: physical pixels for each. Narrow windows are those of a phone."""
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": scale, "mobile": width < 500})
