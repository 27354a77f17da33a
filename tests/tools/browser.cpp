#include "tests/tools/browser.h"

#include <nlohmann/json.hpp>

#include "tests/tools/markup.h"
#include "tests/tools/program.h"

namespace misfit::tools::testing {
namespace {

/// Goes into the head of a page, before all else. What it finds it tells the page around it.
constexpr const char* inspection = R"html(
<meta http-equiv="Content-Security-Policy"
  content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<script>
const found = [];
const named = element => '<' + element.tagName.toLowerCase() + '> ' + (element.getAttribute('alt') || element.textContent).slice(0, 60);
document.addEventListener('securitypolicyviolation', event => found.push('asks for ' + event.blockedURI));
addEventListener('error', event => found.push('error: ' + (event.message || named(event.target))), true);

function inspect_pictures() {
  for (const image of document.images)
    if (!image.complete || image.naturalWidth === 0) found.push('missing picture: ' + named(image));
  for (const drawing of document.querySelectorAll('svg')) {
    const box = drawing.getBoundingClientRect();
    if (!(box.width > 0 && box.height > 0)) found.push('empty drawing: ' + named(drawing));
  }
}

function inspect_text() {
  const no_number = /\b(nan|inf|infinity|undefined|null)\b/i;
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const within = texts.currentNode.parentElement.tagName.toLowerCase();
    if (within === 'script' || within === 'style') continue;
    if (no_number.test(texts.currentNode.data)) found.push('no number: ' + texts.currentNode.data);
  }
  for (const name of ['alt', 'aria-label'])
    for (const element of document.querySelectorAll('[' + name + ']'))
      if (no_number.test(element.getAttribute(name))) found.push('no number: ' + element.getAttribute(name));
}

function inspect_widths() {
  const room = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > room) {
    found.push('wider than the page by ' + (document.documentElement.scrollWidth - room) + ' px');
    for (const element of document.body.querySelectorAll('*'))
      if (element.getBoundingClientRect().right > room && !element.closest('.scroll *')) found.push('too wide: ' + named(element));
  }
  for (const element of document.body.querySelectorAll('*'))
    if (getComputedStyle(element).overflowX === 'hidden' && element.scrollWidth > element.clientWidth && element.clientWidth > 0)
      found.push('cut off: ' + named(element));
}

addEventListener('load', () => {
  if (document.scripts.length > 1) found.push('scripts: ' + (document.scripts.length - 1));
  inspect_pictures();
  inspect_text();
  inspect_widths();
  parent.postMessage(found, '*');
});
</script>
)html";

/// Shows page.html at both widths, and leaves as JSON what was found at each. A window would not be as narrow as a phone.
constexpr const char* surroundings = R"html(<!DOCTYPE html>
<meta charset="utf-8">
<script>
const found = {};
addEventListener('message', event => {
  for (const frame of document.querySelectorAll('iframe'))
    if (frame.contentWindow === event.source) found[frame.width] = event.data;
  const text = JSON.stringify(found);
  document.getElementById('found').textContent =
    text.replace(/[<>&]/g, letter => '\\u00' + letter.charCodeAt(0).toString(16));
});
</script>
<pre id="found"></pre>
<iframe src="page.html" width="360" height="800"></iframe>
<iframe src="page.html" width="1280" height="800"></iframe>
)html";

/// Chromium's standard output: the elements of file `path` once it is loaded. What consoles say goes to standard error.
Outcome show(const std::string& path, const std::string& user_folder) {
  return Child({"--kill-after=5",
                "120",
                "chromium",
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--disable-extensions",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-breakpad",
                "--no-first-run",
                "--hide-scrollbars",
                "--enable-logging=stderr",
                "--host-resolver-rules=MAP * ~NOTFOUND",
                "--user-data-dir=" + user_folder,
                "--window-size=1400,900",
                "--virtual-time-budget=20000",
                "--dump-dom",
                "file://" + path},
               "timeout")
      .wait();
}

/// What `outcome` holds between the tags of the element that the page around leaves.
nlohmann::json found_in(const std::string& dom) {
  const std::string opening = "<pre id=\"found\">";
  const auto start = dom.find(opening) + opening.size();
  return nlohmann::json::parse(dom.substr(start, dom.find("</pre>", start) - start));
}

}  // namespace

boost::test_tools::assertion_result browser_is_installed(boost::unit_test::test_unit_id /*test*/) {
  boost::test_tools::assertion_result installed(std::system("command -v chromium >/dev/null") == 0);
  installed.message() << "there is no chromium; tools/install-packages test installs it";
  return installed;
}

std::vector<std::string> faults_in_browser(const std::string& html) {
  const TemporaryFolder folder;
  const auto head = html.find("<head>");
  BOOST_REQUIRE(head != std::string::npos);
  std::ofstream(folder / "page.html") << html.substr(0, head + 6) << inspection << html.substr(head + 6);
  std::ofstream(folder / "around.html") << surroundings;
  const Outcome outcome = show(folder / "around.html", folder / "user");
  BOOST_TEST_INFO(outcome.err);
  BOOST_REQUIRE_EQUAL(outcome.code, 0);
  BOOST_TEST_INFO(outcome.out);
  BOOST_REQUIRE(contains(outcome.out, "<pre id=\"found\">{"));
  const nlohmann::json found = found_in(outcome.out);
  std::vector<std::string> faults;
  for (const char* width : {"360", "1280"}) {
    BOOST_REQUIRE(found.contains(width));
    for (const auto& fault : found[width]) faults.push_back(std::string(width) + " px: " + fault.get<std::string>());
  }
  std::istringstream said(outcome.err);
  for (std::string line; std::getline(said, line);)
    if (contains(line, "CONSOLE")) faults.push_back("console: " + line);
  return faults;
}

}  // namespace misfit::tools::testing
