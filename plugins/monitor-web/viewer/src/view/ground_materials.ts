import { CustomBlending, OneFactor, OneMinusSrcAlphaFactor, ShaderMaterial, SrcAlphaFactor, Vector3, ZeroFactor } from "three";
import type { Rgb } from "./palette";

// The ground and its lines are drawn first and without a depth test, in the order of Layer: nothing flickers, and
// hidden ground costs no test. They must come before the solids, so lines are blended though three counts them as
// opaque. Shadows and rings are drawn after the solids, because they also lie on flat boxes that some scenes use as
// ground.

export enum Layer {
  Sky = -20,
  Ground,
  Lines,
  Shadows,
  Rings,
}

const flatOnGround = { depthTest: false, depthWrite: false } as const;
// Alpha is not written, so that the canvas stays opaque.
const blended = {
  blending: CustomBlending, blendSrc: SrcAlphaFactor, blendDst: OneMinusSrcAlphaFactor, blendSrcAlpha: ZeroFactor, blendDstAlpha: OneFactor,
} as const;

/// Vertex colours without lighting and conversion.
export function plainMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    ...flatOnGround,
    vertexShader: /* glsl */ `
      attribute vec3 color;
      varying vec3 colour;
      void main() { colour = color; gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0)); }`,
    fragmentShader: /* glsl */ `
      varying vec3 colour;
      void main() { gl_FragColor = vec4(colour, 1.0); }`,
  });
}

/// Lines on the ground that are at least a pixel wide; they fade instead of getting thinner. `screen`: half the canvas
/// size in pixels.
export function lineMaterial(colour: Rgb, screen: Vector3): ShaderMaterial {
  return new ShaderMaterial({
    ...flatOnGround, ...blended,
    uniforms: { ink: { value: new Vector3(...colour) }, screen: { value: screen } },
    vertexShader: /* glsl */ `
      attribute vec2 across;
      uniform vec3 screen;
      varying float strength;
      void main() {
        vec4 middle = projectionMatrix * (viewMatrix * vec4(position, 1.0));
        vec4 edge = projectionMatrix * (viewMatrix * vec4(position.xy + across, position.z, 1.0));
        vec4 next = projectionMatrix * (viewMatrix * vec4(position.x + across.y, position.y - across.x, position.z, 1.0));
        strength = 0.92;
        if (min(middle.w, min(edge.w, next.w)) > 0.1) {
          vec2 start = middle.xy / middle.w * screen.xy;
          vec2 along = normalize(next.xy / next.w * screen.xy - start);
          vec2 aside = vec2(-along.y, along.x);
          float pixels = dot(edge.xy / edge.w * screen.xy - start, aside);
          float missing = max(0.0, 0.62 - abs(pixels)) * (pixels < 0.0 ? -1.0 : 1.0);
          edge.xy += aside * missing / screen.xy * edge.w;
          strength *= max(0.3, min(1.0, abs(pixels) / 0.62));
        }
        gl_Position = edge;
      }`,
    fragmentShader: /* glsl */ `
      uniform vec3 ink;
      varying float strength;
      void main() { gl_FragColor = vec4(ink, strength); }`,
  });
}

/// Spots on the ground, each an instance. `spot`: x, y, radius, strength. In the mesh, x and y are in units of the
/// radius, and z is the fraction of the strength.
export function spotMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -4,
    vertexShader: /* glsl */ `
      attribute vec4 spot;
      attribute vec3 ink;
      varying vec4 colour;
      void main() {
        colour = vec4(ink, spot.w * position.z);
        gl_Position = projectionMatrix * (viewMatrix * vec4(spot.xy + position.xy * spot.z, 0.003, 1.0));
      }`,
    fragmentShader: /* glsl */ `
      varying vec4 colour;
      void main() { gl_FragColor = colour; }`,
  });
}

/// Thin goal nets.
export function netMaterial(colour: Rgb): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true, depthWrite: false,
    uniforms: { ink: { value: new Vector3(...colour) } },
    vertexShader: /* glsl */ `
      void main() { gl_Position = projectionMatrix * (viewMatrix * vec4(position, 1.0)); }`,
    fragmentShader: /* glsl */ `
      uniform vec3 ink;
      void main() { gl_FragColor = vec4(ink, 0.33); }`,
  });
}
