// What is seen: parts with their cages, enclosures and hulls; the camera; which part is under a pointer. Knows no answers.

import {
  Box3, BufferAttribute, BufferGeometry, CircleGeometry, DirectionalLight, DoubleSide, Group, HemisphereLight, LineBasicMaterial,
  LineDashedMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, MeshStandardMaterial, MOUSE, Object3D,
  PCFShadowMap, PerspectiveCamera, Plane, Raycaster, Scene, ShadowMaterial, Sphere, TOUCH, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { TransformControls } from "three/examples/jsm/controls/TransformControls.js";

const dark = matchMedia("(prefers-color-scheme: dark)");
const colours = () =>
  dark.matches
    ? { parts: [0x4f9fd0, 0xf2b673], cage: 0xdfe7ed, enclosure: 0xb9c8d2 }
    : { parts: [0x4787b8, 0xe39a4f], cage: 0x16202a, enclosure: 0x33424e };

// One for each shape, which several parts may have: disposing of it frees what the next picture makes again.
const geometries = new WeakMap();
const geometryOf = (shape) => {
  if (!geometries.has(shape)) geometries.set(shape, newGeometry(shape));
  return geometries.get(shape);
};
const newGeometry = ({ positions, normals, triangles }) => {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  if (normals) geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  if (triangles) geometry.setIndex(new BufferAttribute(triangles, 1));
  if (!normals) geometry.computeVertexNormals();
  return geometry;
};
const linesOf = (points) => {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  return geometry;
};

/** One part in the scene; its layers are replaced one by one. */
class SeenPart {
  constructor(index) {
    this.index = index;
    this.group = new Group();
    this.group.matrixAutoUpdate = false;
    this.layers = new Map();
  }
  colour() {
    return colours().parts[this.index % 2];
  }
  // Replaces a layer by these objects, or takes it away.
  put(name, ...objects) {
    for (const old of this.layers.get(name) ?? []) {
      this.group.remove(old);
      old.geometry.dispose();
      old.material.dispose();
    }
    this.layers.delete(name);
    if (objects.length === 0) return;
    this.layers.set(name, objects);
    this.group.add(...objects);
  }
  show(name, visible) {
    for (const object of this.layers.get(name) ?? []) object.visible = visible;
  }
  shape(shape) {
    const geometry = geometryOf(shape);
    const surface = new Mesh(geometry, new MeshStandardMaterial({ color: this.colour(), roughness: 0.5, metalness: 0, side: DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
    surface.castShadow = surface.receiveShadow = true;
    surface.userData.part = this.index;
    this.put("surface", surface);
    this.put("mesh", new Mesh(geometry, new MeshBasicMaterial({ color: colours().cage, wireframe: true, transparent: true, opacity: 0.55 })));
    if (!geometry.boundingSphere) geometry.computeBoundingSphere();
    this.sphere = geometry.boundingSphere.clone();
  }
  // A's cage in whole lines, B's in dashes.
  cage(edges, size) {
    const how = { color: colours().cage, transparent: true, opacity: 0.75 };
    const lines = new LineSegments(linesOf(edges), this.index % 2 === 0 ? new LineBasicMaterial(how)
      : new LineDashedMaterial({ ...how, dashSize: size / 40, gapSize: size / 60 }));
    lines.computeLineDistances();
    this.put("cage", lines);
  }
  enclosures(shapes) {
    if (!shapes) return this.put("enclosures");
    const glass = new MeshLambertMaterial({ color: this.colour(), transparent: true, opacity: 0.18, side: DoubleSide, depthWrite: false });
    this.put("enclosures", new Mesh(geometryOf(shapes), glass),
      new LineSegments(linesOf(shapes.edges), new LineBasicMaterial({ color: colours().enclosure, transparent: true, opacity: 0.4 })));
  }
  hulls(hulls) {
    if (!hulls) return this.put("hulls");
    const drawn = [];
    for (const [hull, opacity] of [[hulls.outer, 0.22], [hulls.inner, 0.35]]) {
      if (!hull) continue;
      const geometry = geometryOf(hull);
      drawn.push(new Mesh(geometry, new MeshLambertMaterial({ color: this.colour(), transparent: true, opacity, side: DoubleSide, depthWrite: false })),
        new Mesh(geometry, new MeshBasicMaterial({ color: colours().enclosure, wireframe: true, transparent: true, opacity: 0.25 })));
    }
    this.put("hulls", ...drawn);
  }
  // The twelve numbers of a pose.
  place(p) {
    this.group.matrix.set(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11], 0, 0, 0, 1);
    this.group.matrixWorldNeedsUpdate = true;
  }
  placedSphere() {
    this.group.updateMatrixWorld(true);
    return this.sphere.clone().applyMatrix4(this.group.matrixWorld);
  }
}

export class View {
  constructor(stage, onFrame) {
    this.stage = stage;
    this.onFrame = onFrame;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, 0.01, 100);
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    stage.append(this.renderer.domElement);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.sun = new DirectionalLight(0xffffff, 2.3);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 5;
    const fill = new DirectionalLight(0xffffff, 0.5);
    fill.position.set(0.6, -0.2, 1);
    this.camera.add(fill);
    this.ground = new Mesh(new CircleGeometry(1, 64), new ShadowMaterial({ opacity: dark.matches ? 0.4 : 0.16 }));
    this.ground.rotation.x = -Math.PI / 2;
    this.ground.receiveShadow = true;
    this.scene.add(this.camera, this.sun, this.sun.target, new HemisphereLight(0xffffff, 0x8d99a6, 1.5), this.ground);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.ROTATE };
    this.controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_ROTATE };
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.draw());
    this.listenToHandles();
    this.parts = [];
    this.raycaster = new Raycaster();
    this.waiting = false;
    new ResizeObserver(() => this.resize()).observe(stage);
    this.resize();
  }
  // Arrows or rings at the part that moves. `onHandles` is given how far they were dragged: {move} or {axis, degrees}.
  listenToHandles() {
    this.held = new Object3D();
    this.scene.add(this.held);
    this.handles = new TransformControls(this.camera, this.renderer.domElement);
    this.handles.setSize(0.75);
    this.handles.setColors(0xd0453e, 0x3f9a4a, 0x3b6fd4, 0xf0a51f);
    // Its squares and its middle would lie where the part itself is dragged.
    const { gizmo, picker } = this.handles._gizmo;
    for (const set of [gizmo, picker]) {
      for (const mode of ["translate", "rotate"]) {
        for (const each of [...set[mode].children]) if (each.name.length > 1) each.removeFromParent();
      }
    }
    this.scene.add(this.handles.getHelper());
    this.handles.addEventListener("change", () => this.draw());
    this.handles.addEventListener("dragging-changed", ({ value }) => {
      this.controls.enabled = !value;
      if (value) this.onHandles?.("begin");
      else this.handlesTo(this.handled);
    });
    this.handles.addEventListener("objectChange", () => {
      if (this.handles.mode === "translate") this.onHandles?.({ move: this.held.position.clone().sub(this.heldAt).toArray() });
      else {
        const { x, y, z, w } = this.held.quaternion;
        const length = Math.hypot(x, y, z);
        if (length > 0) this.onHandles?.({ axis: [x / length, y / length, z / length], degrees: (2 * Math.atan2(length, w) * 180) / Math.PI });
      }
    });
  }
  // Puts the handles to the middle of a part; without one, or without a mode, away.
  handlesTo(part, mode = this.handlesMode) {
    this.handled = part;
    this.handlesMode = mode;
    if (this.handles.dragging) return;
    if (!part?.sphere || !mode) return this.handles.detach();
    this.heldAt = part.placedSphere().center;
    this.held.position.copy(this.heldAt);
    this.held.quaternion.identity();
    this.handles.setMode(mode);
    this.handles.attach(this.held);
  }
  // Would a pointer there take hold of a handle? Not in the middle, where the part itself is dragged.
  overHandle(x, y) {
    if (!this.handles.object) return false;
    const { left, top, width, height } = this.stage.getBoundingClientRect();
    const middle = this.seen(this.held.position.toArray());
    if (middle && Math.hypot(middle[0] + left - x, middle[1] + top - y) < 16) return false;
    this.scene.updateMatrixWorld();
    this.handles.pointerHover({ x: ((x - left) / width) * 2 - 1, y: 1 - ((y - top) / height) * 2, button: -1 });
    return this.handles.axis !== null;
  }
  part(index) {
    while (this.parts.length <= index) {
      const part = new SeenPart(this.parts.length);
      this.parts.push(part);
      this.scene.add(part.group);
    }
    return this.parts[index];
  }
  keep(count) {
    for (const part of this.parts.splice(count)) {
      for (const name of [...part.layers.keys()]) part.put(name);
      this.scene.remove(part.group);
    }
  }
  resize() {
    const { clientWidth, clientHeight } = this.stage;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(clientWidth, clientHeight);
    this.draw();
  }
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.renderer.render(this.scene, this.camera);
      this.onFrame();
    });
  }
  // Everything in sight, from where it is looked at now.
  fit(direction) {
    const box = new Box3();
    for (const part of this.parts) {
      if (!part.sphere) continue;
      const { center, radius } = part.placedSphere();
      box.union(new Box3().setFromCenterAndSize(center, new Vector3(2, 2, 2).multiplyScalar(radius)));
    }
    if (box.isEmpty()) return;
    const sphere = box.getBoundingSphere(new Sphere());
    const narrow = Math.min(1, this.camera.aspect);
    const away = (0.82 * sphere.radius) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    const from = direction ? new Vector3(...direction) : this.camera.position.clone().sub(this.controls.target);
    this.camera.position.copy(sphere.center).addScaledVector(from.normalize(), away);
    this.camera.near = away / 200;
    this.camera.far = away * 50;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(sphere.center);
    this.controls.update();
    this.light(sphere, box);
    this.draw();
  }
  // From above, in front and to the left of a scene, with a ground below it.
  light({ center, radius }, box) {
    this.sun.position.copy(center).add(new Vector3(-1.2, 2.2, 1.6).multiplyScalar(radius));
    this.sun.target.position.copy(center);
    const { camera } = this.sun.shadow;
    camera.left = camera.bottom = -1.6 * radius;
    camera.right = camera.top = 1.6 * radius;
    camera.near = 0.1 * radius;
    camera.far = 6 * radius;
    camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = radius / 60;  // or facets shade themselves
    this.ground.position.set(center.x, box.min.y - 0.02 * radius, center.z);
    this.ground.scale.setScalar(4 * radius);
  }
  ray(x, y) {
    const { left, top, width, height } = this.stage.getBoundingClientRect();
    this.raycaster.setFromCamera(new Vector2(((x - left) / width) * 2 - 1, 1 - ((y - top) / height) * 2), this.camera);
    return this.raycaster;
  }
  // The part under a place on the screen, and where the ray meets it.
  hit(x, y) {
    this.scene.updateMatrixWorld();
    const surfaces = this.parts.flatMap((part) => part.layers.get("surface") ?? []);
    const found = this.ray(x, y).intersectObjects(surfaces, false)[0];
    return found && { part: found.object.userData.part, point: found.point };
  }
  // Where the ray meets the plane through a point that faces the camera.
  inPlane(x, y, through) {
    const facing = new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), through);
    return this.ray(x, y).ray.intersectPlane(facing, new Vector3());
  }
  axes() {
    this.camera.updateMatrixWorld();
    const e = this.camera.matrixWorld.elements;
    return { right: [e[0], e[1], e[2]], up: [e[4], e[5], e[6]], forward: [-e[8], -e[9], -e[10]] };
  }
  turn(by, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const { right } = this.axes();
    offset.applyAxisAngle(this.camera.up, by).applyAxisAngle(new Vector3(...right), up);
    if (Math.abs(offset.clone().normalize().dot(this.camera.up)) > 0.995) return;
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }
  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
  }
  // In pixels of the stage; nothing behind the camera.
  seen(point) {
    const at = new Vector3(...point).applyMatrix4(this.camera.matrixWorldInverse);
    if (at.z >= -this.camera.near) return null;
    at.applyMatrix4(this.camera.projectionMatrix);
    return [((at.x + 1) / 2) * this.stage.clientWidth, ((1 - at.y) / 2) * this.stage.clientHeight];
  }
  onScheme(change) {
    dark.addEventListener("change", change);
  }
}
