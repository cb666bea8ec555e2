# SPDX-License-Identifier: BSD-3-Clause
"""The page that --html writes."""

import os
import re
import tempfile
import unittest

import live
from cases import InBrowser
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By


class Report(InBrowser):
    """Opened as a file."""

    @classmethod
    def setUpClass(cls):
        if live.URL:
            raise unittest.SkipTest("it needs a run of its own")
        cls.folder_of_all = tempfile.TemporaryDirectory()
        cls.file = os.path.join(cls.folder_of_all.name, "page.html")
        live.run(live.SCENE, "--seconds", "6", "--html", cls.file,
                 "--log", os.path.join(cls.folder_of_all.name, "run.mcap"))

    @classmethod
    def tearDownClass(cls):
        cls.folder_of_all.cleanup()

    def setUp(self):
        super().setUp()
        self.browser.get("file://" + self.file)
        self.charts = self.browser.find_elements(By.CSS_SELECTOR, "figure[data-chart]")

    def tearDown(self):
        self.assertEqual([line for line in self.browser.get_log("browser")], [], "on the console")

    def area(self, chart):
        area = chart.find_element(By.CSS_SELECTOR, ".u-over")
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", area)
        return area

    def values(self, chart):
        return [each.get_attribute("textContent")
                for each in chart.find_elements(By.CSS_SELECTOR, ".u-value")]

    def span(self, chart):
        return self.browser.execute_script(
            "const { min, max } = arguments[0].chart.scales.x; return max - min", chart)

    def test_every_chart_is_drawn(self):
        self.assertEqual(len(self.charts), 6)
        for label in self.browser.find_elements(By.CSS_SELECTOR, ".u-series th[title]"):
            self.assertGreater(len(label.get_attribute("title")), 20)
        for chart in self.charts:
            drawn = self.browser.execute_script(
                "const canvas = arguments[0].querySelector('canvas');"
                "return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height)"
                ".data.some((value) => value > 0)", chart)
            self.assertTrue(drawn, chart.text)

    def test_all_charts_of_time_show_the_moment_at_the_pointer(self):
        distance, pairs, forces = self.charts[:3]
        ActionChains(self.browser).move_to_element_with_offset(self.area(forces), 40, 0).perform()
        live.until(lambda: re.match(r"\d[\d.]* s$", self.values(forces)[0]), "it shows a moment")
        moment, *sizes = self.values(forces)
        for value in sizes:
            self.assertRegex(value, r"^\d[\d.e-]* N$")
        live.until(lambda: self.values(distance)[0] == moment == self.values(pairs)[0],
                   "they show the same")
        for value in self.values(pairs)[1:]:
            self.assertRegex(value, r"^\d+$")

    def test_dragging_zooms_in_and_a_double_click_out(self):
        first, second = self.charts[:2]
        whole = self.span(first)
        self.assertAlmostEqual(whole, 6.0, delta=0.1)
        area = self.area(first)
        ActionChains(self.browser).move_to_element_with_offset(area, -100, 0).click_and_hold() \
            .move_by_offset(200, 10).release().perform()
        live.until(lambda: self.span(first) < 0.5 * whole, "it zooms in")
        live.until(lambda: abs(self.span(second) - self.span(first)) < 0.05, "they do together")
        ActionChains(self.browser).double_click(area).perform()
        live.until(lambda: abs(self.span(first) - whole) < 1e-6, "it zooms out")

    def test_it_follows_a_change_to_the_dark_and_a_narrow_window(self):
        colour = "return getComputedStyle(document.body).backgroundColor"
        light = self.browser.execute_script(colour)
        live.set_theme(self.browser, "dark")
        self.assertNotEqual(self.browser.execute_script(colour), light)
        self.resize(600, 800)
        live.until(lambda: self.charts[0].find_element(By.CSS_SELECTOR, ".uplot").size["width"] <
                   600, "it becomes narrow")
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, ".uplot")),
                         len(self.charts), "each once")
        width = self.browser.execute_script("return document.documentElement.scrollWidth")
        self.assertLessEqual(self.charts[0].size["width"], 600)
        self.assertLessEqual(width, 600)

    def test_slow_ticks_lead_to_their_moment(self):
        links = self.browser.find_elements(By.CSS_SELECTOR, "a[href*='#t=']")
        self.assertEqual(len(links), 8)
        self.assertRegex(links[0].get_attribute("href"), r"^http://127\.0\.0\.1:8448/#t=[\d.]+$")
