import { type Material, MeshDepthMaterial, MeshStandardMaterial, ShaderMaterial, Vector3 } from "three";
import type { Surroundings } from "./palette";

/// Direction to the sun: high, on the side of the broadcast camera, slightly to the left.
export const towardsSun = new Vector3(-0.6, -0.32, 0.74).normalize();

/// The stretching of forms, shared by all shaders that draw them.
const stretch = "corner * (size.xyz - size.w) + normal * size.w";

/// Flat mode: light of sky and sun is computed per vertex, nothing per pixel.
export function flatSolidMaterial(around: Surroundings): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: {
      sun: { value: towardsSun },
      light: { value: new Vector3(around.below, around.above, around.sun) },
    },
    vertexShader: /* glsl */ `
      attribute vec3 corner;
      attribute vec4 size;
      attribute vec4 tint;
      uniform vec3 sun;
      uniform vec3 light;
      varying vec3 colour;
      void main() {
        vec4 world = instanceMatrix * vec4(${stretch}, 1.0);
        vec3 n = mat3(instanceMatrix) * normal;
        float lit = mix(light.x, light.y, 0.5 + 0.5 * n.z) + light.z * max(dot(n, sun), 0.0);
        colour = mix(tint.rgb * lit, vec3(1.0), 0.3 * tint.a);
        gl_Position = projectionMatrix * (viewMatrix * world);
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 colour;
      void main() { gl_FragColor = vec4(colour, 1.0); }`,
  });
}

/// Quality mode: physically based, with shadows.
export function fineSolidMaterial(): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ roughness: 0.42, metalness: 0.02 });
  material.onBeforeCompile = shader => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", `#include <common>
        attribute vec3 corner;
        attribute vec4 size;
        attribute vec4 tint;
        varying vec4 vTint;`)
      .replace("#include <begin_vertex>", `vec3 transformed = ${stretch};
        vTint = vec4(pow(tint.rgb, vec3(2.2)), tint.a);`);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec4 vTint;")
      .replace("#include <color_fragment>", "diffuseColor.rgb = vTint.rgb;")
      .replace("#include <emissivemap_fragment>", `
        // Smooth surfaces reflect the sky at their edges.
        float rim = 1.0 - clamp(dot(normal, normalize(vViewPosition)), 0.0, 1.0);
        totalEmissiveRadiance += vec3(0.55, 0.65, 0.8) * 0.3 * rim * rim * rim * rim + 0.35 * vTint.a * (vTint.rgb + 0.3);`);
  };
  return material;
}

/// The same stretch for the shadow map.
export function solidDepthMaterial(): Material {
  const material = new MeshDepthMaterial();
  material.onBeforeCompile = shader => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute vec3 corner;\nattribute vec4 size;")
      .replace("#include <begin_vertex>", `vec3 transformed = ${stretch};`);
  };
  return material;
}
