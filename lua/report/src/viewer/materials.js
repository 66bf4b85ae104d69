// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// Points and faces in the colours of their values. Positions come in steps of their box, values in steps of their
/// range (65535: none); both are scaled on the graphics card.
import { DataTexture, DoubleSide, ShaderMaterial, Vector2, Vector3 } from "three";
import { sequential } from "../colors.js";
import { last16, none16 } from "../data.js";

const texels = new Uint8Array(sequential.flatMap((c) => [...c, 255]));
const ramp = new DataTexture(texels, 256, 1);
ramp.needsUpdate = true;

/// What all layers of all panes share: the size of points, and the range of colours.
export const shared = {
  pointSize: { value: 3 },
  range: { value: new Vector2(0, 1) },
  ramp: { value: ramp },
};

const colorOf = `
  uniform sampler2D ramp;
  uniform vec2 range;
  uniform vec3 plain;
  uniform bool isColored;
  vec3 colorOf(float value, float none) {
    if (!isColored) return plain;
    if (none > 0.5) return vec3(0.55);
    float t = clamp((value - range.x) / max(range.y - range.x, 1e-12), 0.0, 1.0);
    return texture2D(ramp, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  }
`;

const vertex = `
  attribute float step;
  uniform vec2 valueRange;
  uniform float pointSize;
  varying float vValue;
  varying float vNone;
  varying vec3 vView;
  void main() {
    vNone = step == ${none16.toFixed(1)} ? 1.0 : 0.0;
    vValue = mix(valueRange.x, valueRange.y, step / ${last16.toFixed(1)});
    vec4 view = modelViewMatrix * vec4(position, 1.0);
    vView = view.xyz;
    gl_Position = projectionMatrix * view;
    gl_PointSize = pointSize;
  }
`;

const varyings = "varying float vValue;\nvarying float vNone;\nvarying vec3 vView;\n";

const pointFragment = `${varyings}${colorOf}
  void main() {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    gl_FragColor = vec4(colorOf(vValue, vNone), 1.0);
  }
`;

const faceFragment = `${varyings}${colorOf}
  void main() {
    vec3 normal = normalize(cross(dFdx(vView), dFdy(vView)));
    float light = 0.45 + 0.55 * abs(dot(normal, normalize(vView)));
    gl_FragColor = vec4(colorOf(vValue, vNone) * light, 1.0);
  }
`;

function material(fragmentShader, plain) {
  return new ShaderMaterial({
    vertexShader: vertex, fragmentShader, side: DoubleSide,
    polygonOffset: fragmentShader === faceFragment, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    uniforms: {
      ...shared, plain: { value: new Vector3(...plain) }, isColored: { value: false },
      valueRange: { value: new Vector2(0, 1) },
    },
  });
}

export const pointMaterial = (plain) => material(pointFragment, plain);
export const faceMaterial = (plain) => material(faceFragment, plain);

