// Bundles the panel's page and writes it as a C++ source.
//   node build-panel.mjs OUT.cpp
import { writeFileSync } from 'node:fs'
import { bundleScript, bundleStyle, hashOf, literal, text } from './bundle.mjs'

const script = await bundleScript('src/panel/main.js')
const style = await bundleStyle('src/panel/style.css')

// The content security policy allows only this script, and only connections to the server of the page.
const policy = `default-src 'none'; script-src ${hashOf(script)}; style-src 'unsafe-inline'; img-src data:; connect-src 'self' ws:`
const page = text('src/panel/page.html')
  .replace('{{policy}}', () => policy)
  .replace('{{style}}', () => style)
  .replace('{{script}}', () => `<script>${script}</script>`)

writeFileSync(process.argv[2], `// Made by web/build-panel.mjs.
#include "trammel/panel/page.hpp"

namespace trammel::panel {

std::string_view page() {
  static constexpr char kText[] =
${literal(page)};
  return {kText, sizeof kText - 1};
}

}  // namespace trammel::panel
`)
