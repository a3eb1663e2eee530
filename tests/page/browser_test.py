#!/usr/bin/python3
"""Looks at the pages of write_sample_pages in headless Chromium: browser_test.py FOLDER

Exits with 77 where Chromium, its driver or Selenium is not installed, and says which.
"""

import json
import pathlib
import shutil
import sys
import unittest

SKIPPED = 77
missing = [name for name in ("chromium", "chromedriver") if not shutil.which(name)]
try:
    from browser import Browser
except ImportError as error:
    missing.append(f"Python's {error.name}")
if missing:
    print(f"skipped: not installed: {', '.join(missing)} (scripts/setup.sh --browser installs them)")
    sys.exit(SKIPPED)

FOLDER = pathlib.Path(sys.argv[1]).resolve()
REPORT = json.loads((FOLDER / "sample.json").read_text())
WIDE, NARROW = 1280, 400


class Page(unittest.TestCase):
    page = "sample.html"

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def setUp(self):
        self.browser.open(FOLDER / self.page, WIDE)

    def tearDown(self):
        self.assertEqual(self.browser.console(), [])
        self.assertEqual(self.browser.requests(), [(FOLDER / self.page).as_uri()])

    def point(self, identity):
        return self.browser.one(f'g.point[data-id="{identity}"]')

    def text(self, selector):
        return self.browser.one(selector).text

    def places(self):
        return {node.get_attribute("data-id"): node.get_attribute("transform") for node in self.browser.all("g.point")}


class Chart(Page):
    def test_has_every_point_and_the_front(self):
        self.assertEqual(len(self.browser.all("g.point")), len(REPORT["points"]))
        front = [int(node.get_attribute("data-id")) for node in self.browser.all("g.point.front")]
        self.assertEqual(sorted(front), sorted(REPORT["front"]))
        self.assertEqual(len(self.browser.all("#front-list li")), len(front))

    def test_lower_error_is_lower_and_longer_time_is_right(self):
        places = self.browser.script("""
            return [...document.querySelectorAll('g.point')].map((node) => {
                const [x, y] = node.getAttribute('transform').split(/[( )]/).slice(1, 3).map(Number);
                return [Number(node.dataset.id), x, y];
            })""")
        points = REPORT["points"]
        by_time = [points[i]["time"]["median"] for i, _, _ in sorted(places, key=lambda place: place[1])]
        self.assertEqual(by_time, sorted(by_time))
        by_height = [points[i]["error"]["relMse"]["median"] for i, _, _ in sorted(places, key=lambda place: -place[2])]
        self.assertEqual(by_height, sorted(by_height))

    def test_whiskers_and_the_noise_of_the_reference(self):
        self.assertEqual(len(self.browser.all("#error-time .whisker")), len(REPORT["points"]))
        self.assertEqual(len(self.browser.all("#error-time .noise")), 1)
        self.assertEqual(len(self.browser.all("#error-time .front-line")), 1)
        self.browser.choose("#metric", "flip")
        self.assertNotIn("flip", REPORT["reference"]["noise"])
        self.assertEqual(self.browser.all("#error-time .noise"), [])

    def test_names_the_default_and_the_front(self):
        labels = [label.text for label in self.browser.all(".label")]
        self.assertIn("default", labels)
        names = [REPORT["points"][identity]["name"] for identity in REPORT["front"]]
        for label in labels:
            self.assertTrue(any(name.startswith(label.rstrip("…")) for name in [*names, "default"]), label)

    def test_pointing_shows_every_setting(self):
        point = REPORT["points"][REPORT["front"][-1]]
        self.browser.point_at(self.point(point["id"]))
        shown = self.text("#detail")
        self.assertIn(point["name"], shown)
        for setting in REPORT["settings"]:
            value = point["settings"].get(setting["name"], setting["default"])
            self.assertRegex(shown, rf"{setting['name']}\s+{value}")
        self.assertIn(point["name"], self.text("#tip"))

    def test_keyboard_goes_from_point_to_point_and_selects(self):
        self.browser.script("document.querySelector('g.point[tabindex=\"0\"]').focus()")
        self.browser.press("HOME")
        by_time = sorted(REPORT["points"], key=lambda point: point["time"]["median"])
        self.assertIn(by_time[0]["name"], self.text("#detail h3"))
        self.browser.press("ARROW_RIGHT")
        self.assertIn(by_time[1]["name"], self.text("#detail h3"))
        self.browser.press("ENTER")
        self.assertIn("selected", self.point(by_time[1]["id"]).get_attribute("class"))
        self.assertEqual(len(self.browser.all("g.point.selected")), 1)

    def test_click_selects(self):
        last = REPORT["front"][-1]
        self.browser.click_at(self.point(last))
        self.assertIn("selected", self.point(last).get_attribute("class"))
        self.assertEqual(len(self.browser.all("#pass-bars g.bar")), 3)

    def test_the_measure_moves_points_and_the_front_follows(self):
        relative = self.places()
        for metric in ("psnr", "p999", "flip", "bias"):
            self.browser.choose("#metric", metric)
            places = self.places()
            self.assertEqual(places.keys(), relative.keys())
            self.assertNotEqual(places, relative)
            self.assertGreater(len(self.browser.all("g.point.front")), 0)
        self.browser.choose("#metric", "psnr")
        infinite = next(point["id"] for point in REPORT["points"] if point["error"]["psnr"] is None)
        lowest = max(self.places().values(), key=lambda place: float(place.split()[1].rstrip(")")))
        self.assertEqual(self.places()[str(infinite)], lowest)

    def test_filters(self):
        self.browser.script("document.querySelector('.filters').open = true")
        self.assertEqual(self.browser.all('[data-setting="max-interfaces"]'), [])
        self.browser.choose('[data-setting="spp"]', "16")
        expected = [point["id"] for point in REPORT["points"] if point["settings"].get("spp") == "16"]
        self.assertEqual(len(self.browser.all("g.point")), len(expected))
        self.assertIn(f"{len(expected)} of", self.text("#shown"))
        rows = self.browser.all("#points-table tbody tr")
        self.assertEqual({int(row.get_attribute("data-id")) for row in rows}, set(expected))
        self.browser.one("#clear-filter").click()
        self.assertEqual(len(self.browser.all("g.point")), len(REPORT["points"]))

    def test_labels_do_not_overlap(self):
        for width in (WIDE, NARROW):
            self.browser.resize(width)
            boxes = self.browser.script("""
                return [...document.querySelectorAll('.label')].map((label) => {
                    const {left, right, top, bottom} = label.getBoundingClientRect();
                    return [left, right, top, bottom];
                })""")
            self.assertGreater(len(boxes), len(REPORT["front"]) / 2)
            for i, (left, right, top, bottom) in enumerate(boxes):
                for other in boxes[:i]:
                    across = min(right, other[1]) - max(left, other[0])
                    down = min(bottom, other[3]) - max(top, other[2])
                    # Text boxes have the height of the font's line, which is more than that of its letters.
                    self.assertFalse(across > 0 and down > 3, (boxes[i], other))


class Rest(Page):
    def test_settings_table_sorts(self):
        ratios = self.ratios()
        self.browser.one('[data-sort="ratio"]').click()
        self.assertEqual(self.ratios(), sorted(ratios))
        self.browser.one('[data-sort="ratio"]').click()
        self.assertEqual(self.ratios(), sorted(ratios, reverse=True))
        self.assertEqual(self.browser.one('th[aria-sort="descending"]').text.split()[0], "Time")
        rows = self.browser.all("#settings-table tbody tr")
        skipped = sum(len({entry["reason"] for entry in setting["skipped"]}) for setting in REPORT["settings"])
        self.assertEqual(len(rows), skipped + sum(len(setting["values"]) for setting in REPORT["settings"]))
        self.assertTrue(all("not measured: " in row.text for row in rows[-skipped:]))

    def ratios(self):
        cells = self.browser.all("#settings-table tbody tr:not(.skipped) td:nth-of-type(3)")
        return [float(cell.text.lstrip("×").split()[0]) for cell in cells]

    def test_settings_table_says_ties_and_what_is_chosen_at_build(self):
        table = self.text("#settings-table")
        ties = [point for point in REPORT["points"] if len(point["settings"]) == 1 and point["timeTie"]]
        self.assertGreater(len(ties), 0)
        self.assertEqual(len(self.browser.all("#settings-table td:nth-of-type(3) .tie")), len(ties))
        self.assertRegex(table, r"max-interfaces\s+2, 16\s+render\s+not measured: nothing refracts")
        self.assertIn("same picture", table)
        self.assertRegex(table, r"texture-lod\s+mip0\s+build")
        self.assertRegex(table, r"spp\s+1\s+render")

    def test_shares_of_the_error(self):
        rows = self.browser.all("#error-parts-table tbody tr")
        parts = REPORT["errorParts"]["parts"]
        self.assertEqual(len(rows), len(parts) + 3)
        for row, part in zip(rows, parts):
            self.assertIn(f"{part['setting']} {part['to']} instead of {part['from']}", row.text)
            for share in (part["bias"], part["noise"], part["removed"]["median"]):
                self.assertIn(f"{100 * share:#.3g} %".replace("-", "−"), row.text)
        self.assertIn("all of light transport", self.text("#error-parts-note"))
        rows[-1].find_element("css selector", "button").click()
        self.assertIn("selected", self.point(REPORT["errorParts"]["exact"]["point"]).get_attribute("class"))

    def test_value_by_value(self):
        def heights(chart):
            steps = self.browser.all(f"#ladder-box svg:nth-of-type({chart}) g:nth-of-type(2) .step")
            return [float(step.get_attribute("cy")) for step in steps]

        # More bounces: less error, so lower in the chart, and more time.
        self.assertEqual(len(heights(1)), 4)
        self.assertEqual(heights(1), sorted(heights(1)))
        self.assertEqual(heights(2), sorted(heights(2), reverse=True))
        self.assertIn("max-roughness 1", self.text("#ladder-legend"))
        captions = [figure.text.split(" ")[:2] for figure in self.browser.all("#ladder-pictures figcaption")]
        self.assertEqual(captions[:4], [["bounces", value] for value in ("1", "2", "4", "unlimited")])
        self.assertEqual(captions[4][0], "reference")
        self.browser.choose("#ladder-of", "lights")
        self.assertEqual(len(self.browser.all("#ladder-pictures figure")), 5)
        labels = [text.text for text in self.browser.all("#ladder-box svg:nth-of-type(1) .axes text")]
        self.assertTrue({"all", "1", "4", "16", "--lights"} <= set(labels), labels)

    def test_slider_reveals(self):
        over = "return getComputedStyle(document.querySelector('#slider-left')).clipPath"
        before = self.browser.script(over)
        self.browser.one("#reveal").send_keys(*[self.browser.key("ARROW_RIGHT")] * 20)
        self.assertNotEqual(self.browser.script(over), before)
        self.assertIn("30%", self.browser.script(over))
        left = self.browser.one("#slider-left").get_attribute("src")
        self.browser.choose("#left", str(REPORT["front"][0]))
        self.assertNotEqual(self.browser.one("#slider-left").get_attribute("src"), left)
        self.browser.choose("#layer", "errorImage")
        self.assertIn("error", self.browser.one("#slider-left").get_attribute("alt"))

    def test_every_picture_is_drawn(self):
        self.browser.choose("#grid-of", "shown")
        self.assertEqual(len(self.browser.all("#grid figure")), len(REPORT["points"]) + 1)
        self.assertTrue(self.browser.script("""
            return [...document.images].every((image) => image.complete && image.naturalWidth === 96)"""))

    def test_bars_of_passes(self):
        self.browser.choose("#passes-of", "setting spp")
        spp = next(setting for setting in REPORT["settings"] if setting["name"] == "spp")
        self.assertEqual(len(self.browser.all("#pass-bars g.bar")), len(spp["values"]))
        widths = self.browser.script("""
            return [...document.querySelectorAll('#pass-bars g.bar')].map((bar) =>
                [...bar.querySelectorAll('rect')].reduce((sum, rect) => sum + Number(rect.getAttribute('width')), 0))""")
        self.assertEqual(widths, sorted(widths))
        self.assertAlmostEqual(widths[5] / widths[2], 8.1, delta=0.05)
        self.browser.choose("#passes-scale", "share")
        self.assertEqual(len(self.browser.all("#pass-bars g.bar")), len(widths))

    def test_words(self):
        for sentence in ("Fastest: ", "Most exact: ", "The default takes ", "For a budget of 20.0 ms: ", "The fastest strategy is visibility"):
            self.assertIn(sentence, self.text("#summary"))
        self.assertEqual(self.text("#command"), REPORT["command"])
        self.assertIn("7 rounds", self.text("#method-text"))
        self.assertIn("relative standard error is 0.610 %; the target of 0.500 % is not reached", self.text("#method-text"))
        self.assertEqual(len(self.browser.all("#strategies-table tbody tr")), 3)

    def test_nothing_is_wider_than_a_small_window(self):
        self.browser.resize(NARROW)
        self.assertLessEqual(self.browser.script("return document.documentElement.scrollWidth"), NARROW)
        self.assertLessEqual(int(self.browser.one("#error-time").get_attribute("width")), NARROW)

    def test_texts_stand_out_in_both_schemes(self):
        for scheme in ("light", "dark"):
            self.browser.prefer(scheme)
            for selector in ("h1", "p", ".note", "#facts dt", "#settings-table td", "#settings-table .skipped td", "#detail th", "#detail td",
                             ".was", ".tie", "a", ".link", "button", "select", ".axes text", ".label", "code"):
                self.assertGreaterEqual(self.browser.contrast(selector), 4.5, f"{selector} in the {scheme} scheme")
            for selector in (".marker", ".ring", ".front-line"):
                self.assertGreaterEqual(self.browser.contrast(selector), 2.2, f"{selector} in the {scheme} scheme")


class HostileNames(Page):
    page = "hostile.html"

    def test_stay_text(self):
        self.assertIsNone(self.browser.script("return window.broken ?? null"))
        self.assertIn("</script><script>window.broken = 1</script><!--", self.text("h1"))
        self.assertEqual(len(self.browser.all("script")), 3)
        self.assertEqual(self.browser.script("return [...document.images].filter((image) => !image.src.startsWith('data:')).length"), 0)
        self.browser.point_at(self.point(1))
        self.assertIn("<img src=x", self.text("#detail h3"))


class SparseReport(Page):
    page = "sparse.html"

    def test_shows_what_there_is(self):
        self.assertEqual(len(self.browser.all("g.point")), 1)
        self.assertIn("No strategies", self.text("#strategies"))
        self.assertFalse(self.browser.one("#images").is_displayed())
        self.assertFalse(self.browser.one("#passes").is_displayed())
        self.assertFalse(self.browser.one("#error-parts").is_displayed())
        self.assertFalse(self.browser.one("#ladder").is_displayed())
        self.assertNotIn("NaN", self.browser.script("return document.body.innerHTML.replace(/<script.*?<\\/script>/gs, '')"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
