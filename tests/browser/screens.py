"""Screens of computers and phones, light and dark, and measurements of a page on them."""

from contextlib import contextmanager

SCREENS = {"computer": (1440, 900), "phone": (390, 844)}
SCHEMES = ("light", "dark")

# ratio of luminances of each visible text and what is behind it (WCAG 2.2, 1.4.3); text of controls
# that are disabled, and signs beside a text, need none
CONTRASTS = """
    const rgb = colour => colour.match(/[\\d.]+/g).map(Number);
    const luminance = colour => {
      const [r, g, b] = rgb(colour).map(one => one / 255)
        .map(one => (one <= 0.04045 ? one / 12.92 : ((one + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const behind = element => {
      for (let box = element; box; box = box.parentElement) {
        const colour = getComputedStyle(box).backgroundColor, [, , , alpha] = rgb(colour);
        if (alpha === undefined || alpha === 1) return colour;
      }
      return "rgb(255, 255, 255)";
    };
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), ratios = [];
    while (walker.nextNode()) {
      const element = walker.currentNode.parentElement, text = walker.currentNode.data.trim();
      if (!text || !element.checkVisibility({ visibilityProperty: true })) continue;
      if (element.closest("script, style, noscript, option")) continue;
      if (element.closest(":disabled, [aria-hidden=true]")) continue;
      const levels = [getComputedStyle(element).color, behind(element)].map(luminance);
      ratios.push([(Math.max(...levels) + 0.05) / (Math.min(...levels) + 0.05), text]);
    }
    return ratios;"""


@contextmanager
def emulated_screen(page, width, height, mobile=True, scheme="light"):
    """Show a page of the browser on a screen of this size in pixels, with a colour scheme."""
    size = {"width": width, "height": height, "screenWidth": width, "screenHeight": height}
    size |= {"deviceScaleFactor": 1 + mobile, "mobile": mobile}
    page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    preference = {"name": "prefers-color-scheme", "value": scheme}
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [preference]})
    try:
        # a wide page of the test before would have another innerWidth
        page.wait(lambda: page.script("return screen.width") == width)
        yield
    finally:
        page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def boxes(page, selector):
    """Return the rectangles of all elements that match a CSS selector, in pixels of the window."""
    return page.script(
        """return [...document.querySelectorAll(arguments[0])]
        .map(element => element.getBoundingClientRect().toJSON())""",
        selector,
    )


def contrasts(page):
    """Return the contrast of each visible text with its background, and the text."""
    return page.script(CONTRASTS)
