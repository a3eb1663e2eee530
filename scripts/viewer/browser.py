"""Headless Chromium with the Khronos glTF viewer in it (page.html)."""
import base64
import contextlib
import functools
import http.server
import os
import pathlib
import shutil
import tempfile
import threading
import time

import numpy as np
from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.chrome.service import Service

HERE = pathlib.Path(__file__).resolve().parent
# WebGL runs on the CPU. One draw of the filter of the environment map can take longer than the watchdog allows.
ARGUMENTS = ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--use-gl=angle",
             "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
             "--disable-gpu-watchdog")
SECONDS = 1800  # for one call, on a slow machine


class ViewerError(Exception):
    """Says what the viewer or the browser could not do."""


class Handler(http.server.SimpleHTTPRequestHandler):
    """Serves several folders, each under its own name."""

    def __init__(self, *arguments, folders, **options):
        self.folders = folders
        super().__init__(*arguments, **options)

    def translate_path(self, path):
        name, _, rest = path.lstrip("/").partition("/")
        self.directory = self.folders.get(name, os.devnull)
        return super().translate_path("/" + rest)

    def log_message(self, *arguments):
        pass


@contextlib.contextmanager
def serve(folders):
    """Yields the address of a server of these folders."""
    handler = functools.partial(Handler, folders={name: str(folder) for name, folder in folders.items()})
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        server.server_close()


class Viewer:
    """A page with the viewer. `work` is the folder that the environment map and the scenes are in."""

    def __init__(self, package, work):
        self.stack = contextlib.ExitStack()
        self.address = self.stack.enter_context(serve({"page": HERE, "viewer": package, "files": work}))
        profile = tempfile.mkdtemp(prefix="glint-viewer-")
        self.stack.callback(shutil.rmtree, profile, ignore_errors=True)
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for argument in (*ARGUMENTS, f"--user-data-dir={profile}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
        self.stack.callback(self.driver.quit)
        self.driver.set_script_timeout(SECONDS)
        self.driver.get(self.address + "/page/page.html")
        end = time.monotonic() + 60
        while not self.driver.execute_script("return window.isReady === true"):
            if time.monotonic() > end:
                raise ViewerError("the page did not start: " + "; ".join(self.console()))
            time.sleep(0.1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stack.close()

    def console(self):
        """The errors that the page has logged since the last call."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def call(self, function, *arguments):
        script = """
            const [name, args, done] = arguments;
            (async () => window[name](...args))().then((value) => done({ value: value ?? null }),
                                                       (error) => done({ error: String(error.stack ?? error) }));
        """
        try:
            result = self.driver.execute_async_script(script, function, arguments)
        except WebDriverException as error:
            raise ViewerError(f"{function}: {error.msg}") from error
        if "error" in result:
            raise ViewerError(f"{function}: {result['error']}")
        return result["value"]

    def use_environment(self, map_name, sheen_albedo_name):
        self.call("useEnvironment", f"/files/{map_name}", f"/files/{sheen_albedo_name}")

    def use_scene(self, name):
        """Loads a scene below the work folder. Returns the names of its materials."""
        self.console()
        return self.call("useScene", f"/files/{name}")

    def render(self, camera, width, height):
        """Returns the radiance (height, width, 3), the regions (height, width) and the cosines of the view."""
        result = self.call("renderScene", camera, width, height)

        def floats(name, count):
            data = np.frombuffer(base64.b64decode(result[name]), dtype="<f4")
            return data.reshape(height, width, count)

        regions = floats("regions", 2)
        return floats("radiance", 3), regions[..., 0].astype(int), regions[..., 1]

    def to_jpeg(self, name):
        """The bytes of a picture below the work folder as JPEG."""
        return base64.b64decode(self.call("toJpeg", f"/files/{name}"))
