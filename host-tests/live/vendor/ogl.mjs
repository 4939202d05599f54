// What the view of points takes of OGL. `npm ci && npm run build` in this folder writes ogl.bundle.

export { Camera } from "ogl/src/core/Camera.js";
export { Geometry } from "ogl/src/core/Geometry.js";
export { Mesh } from "ogl/src/core/Mesh.js";
export { Program } from "ogl/src/core/Program.js";
export { Renderer } from "ogl/src/core/Renderer.js";
export { Orbit } from "ogl/src/extras/Orbit.js";
export { Vec3 } from "ogl/src/math/Vec3.js";
