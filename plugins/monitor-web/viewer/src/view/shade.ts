import {
  DoubleSide, type Material as Paint, MeshDepthMaterial, MeshDistanceMaterial, MeshStandardMaterial, ShaderMaterial,
  type ShaderMaterialParameters, type Texture, Vector3,
} from "three";
import type { Lamps } from "./lamps";
import type { Rgb, Surroundings } from "./palette";

/// Direction to the sun: high, on the side of the broadcast camera, slightly to the left.
export const towardsSun = new Vector3(-0.6, -0.32, 0.74).normalize();

/// The stretching of forms, shared by all shaders that draw them.
const stretch = "corner * (size.xyz - size.w) + normal * size.w";

/// Light at a point with a normal: of the scene's lamps, or of sky and sun.
const light = /* glsl */ `
  #ifdef LAMPS
    uniform vec3 lamps[LAMPS];
    uniform vec3 lampColours[LAMPS];
    vec3 lit(vec3 n, vec3 at) {
      vec3 sum = vec3(0.0);
      for (int i = 0; i < LAMPS; i++) sum += lampColours[i] * max(dot(n, normalize(lamps[i] - at)), 0.0);
      return sum;
    }
  #else
    uniform vec3 sun;
    uniform vec3 light;
    vec3 lit(vec3 n, vec3 at) { return vec3(mix(light.x, light.y, 0.5 + 0.5 * n.z) + light.z * max(dot(n, sun), 0.0)); }
  #endif`;

function flatLight(around: Surroundings, lamps: Lamps | null): Pick<ShaderMaterialParameters, "uniforms" | "defines"> {
  if (lamps) return { uniforms: { ...lamps.uniforms }, defines: { LAMPS: lamps.uniforms.lamps.value.length } };
  return { uniforms: { sun: { value: towardsSun }, light: { value: new Vector3(around.below, around.above, around.sun) } }, defines: {} };
}

/// Flat mode: light is computed per vertex, nothing per pixel.
export function flatSolidMaterial(around: Surroundings, lamps: Lamps | null): ShaderMaterial {
  return new ShaderMaterial({
    ...flatLight(around, lamps),
    vertexShader: /* glsl */ `
      attribute vec3 corner;
      attribute vec4 size;
      attribute vec4 tint;
      attribute vec3 base;
      varying vec3 colour;
      ${light}
      void main() {
        vec4 world = instanceMatrix * vec4(${stretch}, 1.0);
        vec3 n = mat3(instanceMatrix) * normal;
        colour = mix(base + tint.rgb * lit(n, world.xyz), vec3(1.0), 0.3 * tint.a);
        gl_Position = projectionMatrix * (viewMatrix * world);
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 colour;
      void main() { gl_FragColor = vec4(colour, 1.0); }`,
  });
}

/// The same for triangles of mesh files, seen from both sides.
export function flatMeshMaterial(
  around: Surroundings, lamps: Lamps | null, colour: Rgb, base: Rgb, opacity: number, map: Texture | null,
): ShaderMaterial {
  const { uniforms, defines } = flatLight(around, lamps);
  return new ShaderMaterial({
    uniforms: {
      ...uniforms,
      tint: { value: new Vector3(...colour) },
      base: { value: new Vector3(...base) },
      opacity: { value: opacity },
      picture: { value: map },
    },
    defines: { ...defines, ...(map && { PICTURE: "" }) },
    side: DoubleSide,
    transparent: opacity < 1,
    vertexShader: /* glsl */ `
      uniform vec3 tint;
      uniform vec3 base;
      varying vec3 colour;
      varying vec2 place;
      ${light}
      void main() {
        mat3 m = mat3(instanceMatrix);
        vec4 world = instanceMatrix * vec4(position, 1.0);
        vec3 n = m * (normal / max(vec3(dot(m[0], m[0]), dot(m[1], m[1]), dot(m[2], m[2])), vec3(1e-12)));
        n = faceforward(normalize(n), world.xyz - cameraPosition, n);
        colour = base + tint * lit(n, world.xyz);
        #ifdef USE_INSTANCING_COLOR
          colour = mix(vec3(1.0), colour, instanceColor);
        #endif
        place = uv;
        gl_Position = projectionMatrix * (viewMatrix * world);
      }`,
    fragmentShader: /* glsl */ `
      uniform float opacity;
      uniform sampler2D picture;
      varying vec3 colour;
      varying vec2 place;
      void main() {
        gl_FragColor = vec4(colour, opacity);
        #ifdef PICTURE
          gl_FragColor *= texture2D(picture, place);
        #endif
      }`,
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
        attribute vec3 base;
        varying vec4 vTint;
        varying vec3 vBase;`)
      .replace("#include <begin_vertex>", `vec3 transformed = ${stretch};
        vTint = vec4(pow(tint.rgb, vec3(2.2)), tint.a);
        vBase = pow(base, vec3(2.2));`);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec4 vTint;\nvarying vec3 vBase;")
      .replace("#include <color_fragment>", "diffuseColor.rgb = vTint.rgb;")
      .replace("#include <emissivemap_fragment>", `
        // Smooth surfaces reflect the sky at their edges.
        float rim = 1.0 - clamp(dot(normal, normalize(vViewPosition)), 0.0, 1.0);
        totalEmissiveRadiance += vec3(0.55, 0.65, 0.8) * 0.3 * rim * rim * rim * rim + 0.35 * vTint.a * (vTint.rgb + 0.3) + vBase;`);
  };
  return material;
}

/// The same stretch for shadow maps: of the sun, and of lamps.
export function solidDepthMaterial(): Paint {
  return stretched(new MeshDepthMaterial());
}

export function solidDistanceMaterial(): Paint {
  return stretched(new MeshDistanceMaterial());
}

function stretched(material: Paint): Paint {
  material.onBeforeCompile = shader => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute vec3 corner;\nattribute vec4 size;")
      .replace("#include <begin_vertex>", `vec3 transformed = ${stretch};`);
  };
  return material;
}
