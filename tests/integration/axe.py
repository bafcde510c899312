"""axe-core on a page that a browser shows: what it finds serious or critical. ./test --full fetches it (cmake/fetch/axe)."""
import pathlib
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / ".deps/axe/axe.min.js"
needed = unittest.skipUnless(SCRIPT.exists(), "not installed: axe-core (cmake/fetch/axe .deps/axe)")


def findings(driver):
    """[(rule, impact, elements)] of the page as it is now."""
    driver.set_script_timeout(300)  # a page of 200 rows, where the processor is shared
    driver.execute_script(SCRIPT.read_text())
    found = driver.execute_async_script("const then = arguments[0]; axe.run().then((all) => then(all.violations))")
    return [(one["id"], one["impact"], [node["html"][:200] for node in one["nodes"]][:3]) for one in found
            if one["impact"] in ("serious", "critical")]
