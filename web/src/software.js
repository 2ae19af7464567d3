// Whether the browser draws WebGL on the processor, because there is no graphics card.
export function drawsInSoftware() {
  const context = document.createElement('canvas').getContext('webgl2')
  const names = context?.getExtension('WEBGL_debug_renderer_info')
  const name = names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : ''
  context?.getExtension('WEBGL_lose_context')?.loseContext()
  return /swiftshader|llvmpipe|softpipe|basic render/i.test(name)
}
