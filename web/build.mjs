// Bundles the report's page and writes it as a C++ source: the text before a report's data and the text after it.
//   node build.mjs OUT.cpp
import { writeFileSync } from 'node:fs'
import { bundleScript, bundleStyle, hashOf, licencesOf, literal, text } from './bundle.mjs'

const packages = Object.keys(JSON.parse(text('package.json')).dependencies)
const script = await bundleScript('src/main.js', { TRAMMEL_LICENCES: JSON.stringify(licencesOf(packages)) })
const style = await bundleStyle('src/style.css')

// The content security policy allows only this script and loads nothing. It is a second protection, because the page
// shows third-party programs.
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
