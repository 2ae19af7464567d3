// Bundles the report's page and writes it as a C++ source: what comes before a report's data and what comes behind.
//   node build.mjs OUT.cpp
import { writeFileSync } from 'node:fs'
import { bundleScript, bundleStyle, hashOf, licencesOf, literal, text } from './bundle.mjs'

const packages = Object.keys(JSON.parse(text('package.json')).dependencies)
const script = await bundleScript('src/main.js', { TRAMMEL_LICENCES: JSON.stringify(licencesOf(packages)) })
const style = await bundleStyle('src/style.css')

// Only this very script runs, and nothing is loaded: a page made of other people's programs needs a second lock.
const policy = `default-src 'none'; script-src ${hashOf(script)}; style-src 'unsafe-inline'; img-src data: blob:`
const head = text('src/page.html')
  .replace('{{policy}}', () => policy)
  .replace('{{style}}', () => style)
const tail = `<script>${script}</script>\n</body>\n</html>\n`

writeFileSync(process.argv[2], `// Made by web/build.mjs.
#include "trammel/report/page.hpp"

namespace trammel::report {

std::string_view page_head() {
  static constexpr char kText[] =
${literal(head)};
  return {kText, sizeof kText - 1};
}

std::string_view page_tail() {
  static constexpr char kText[] =
${literal(tail)};
  return {kText, sizeof kText - 1};
}

}  // namespace trammel::report
`)
