/** The floors in three dimensions on a canvas (WebGL), seen from where they were turned to.  Loaded only when
 * that view is opened. */
import {
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  OrthographicCamera,
  Path,
  Scene,
  Shape,
  ShapeGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { Colours } from "../plan/colours";
import type { FloorChoice } from "../uiState";
import { cornersOf, type Corner, type Place3, type StackedBuilding, type StackedFloor } from "./building";
import type { StackedPath } from "./paths";

export interface StackLook {
  colours: Colours;
  shown: FloorChoice; // this floor stands out
  spread: number; // heights are drawn this many times larger
}

const FIRST_AZIMUTH_RAD = -0.6; // from the south-west
const FIRST_POLAR_RAD = 1.05; // from above; 0 is straight down
const STEEPEST_RAD = 1.5; // nearly from the side
const BESIDE_PX = { x: 60, y: 40 }; // about the building, for marks and names
const WALL_PX = 1.6;
const STANDING_OUT_PX = 3;
const TRAIL_PX = 2.5;
const ROUTE_PX = 5;
const FAINT = 0.5;

export class StackCanvas {
  private readonly renderer: WebGLRenderer;
  private readonly camera = new OrthographicCamera();
  private readonly controls: OrbitControls;
  private readonly scene = new Scene();
  private readonly building = new Group();
  private readonly paths = new Group();
  private radiusM = 10;
  private spread = 1;
  private size = new Vector2(1, 1);

  /** `turned`: the view has changed.  Raises an error where the browser has no WebGL. */
  constructor(canvas: HTMLCanvasElement, turned: () => void) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.scene.add(this.building, this.paths);
    this.camera.up.set(0, 0, 1);
    const { x, y, z } = new Vector3().setFromSphericalCoords(1, FIRST_POLAR_RAD, FIRST_AZIMUTH_RAD);
    this.camera.position.set(x, -z, y); // z is up here
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = STEEPEST_RAD;
    this.controls.minZoom = 0.3;
    this.controls.maxZoom = 20;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", turned);
  }

  /** Frees the graphics memory. */
  close(): void {
    this.controls.dispose();
    empty(this.building);
    empty(this.paths);
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  resize(widthPx: number, heightPx: number): void {
    this.size = new Vector2(widthPx, heightPx);
    this.renderer.setSize(widthPx, heightPx, false);
  }

  showBuilding({ floors, edges, bounds }: StackedBuilding, look: StackLook): void {
    const upM = bounds.upM.map((one) => one * look.spread) as [number, number];
    const size = new Vector3(...[bounds.eastM, bounds.northM, upM].map(([from, to]) => to - from));
    this.radiusM = size.length() / 2;
    this.spread = look.spread;
    empty(this.building);
    for (const floor of floors) this.building.add(...floorObjects(floor, look));
    const stairs = edges.map((edge) => edge.map((place) => this.raised(place)));
    this.building.add(...lines(stairs, look.colours.wall, WALL_PX, FAINT));
  }

  /** The complete building in the current view. */
  fit(building: StackedBuilding): void {
    const { eastM, northM, upM } = building.bounds;
    const middle = ([from, to]: readonly [number, number]) => (from + to) / 2;
    const direction = this.camera.position.clone().sub(this.controls.target);
    this.controls.target.set(middle(eastM), middle(northM), middle(upM) * this.spread);
    this.camera.position.copy(this.controls.target).add(direction.setLength(2 * this.radiusM));
    this.camera.zoom = 1;
    this.controls.update();
    this.frame();
    const outline = cornersOf(building).map((corner) => this.pixelOf(corner));
    const extent = (axis: 0 | 1) => {
      const pixels = outline.map((one) => one[axis]);
      return Math.max(1, Math.max(...pixels) - Math.min(...pixels));
    };
    const room = (px: number, besidePx: number) => Math.max(px / 2, px - 2 * besidePx);
    this.camera.zoom = Math.min(
      room(this.size.x, BESIDE_PX.x) / extent(0),
      room(this.size.y, BESIDE_PX.y) / extent(1),
    );
    this.frame();
    this.controls.update();
  }

  showPaths(trails: readonly StackedPath[], route: readonly Place3[] | null, look: StackLook): void {
    empty(this.paths);
    for (const { places, urgency, chosen } of trails) {
      const colour = chosen ? look.colours.chosen : look.colours[urgency];
      this.paths.add(...lines([places.map((place) => this.raised(place))], colour, TRAIL_PX, 1));
    }
    if (route === null) return;
    this.paths.add(...lines([route.map((place) => this.raised(place))], look.colours.chosen, ROUTE_PX, 1));
  }

  turn(leftRad: number, upRad: number): void {
    this.controls.rotateLeft(leftRad);
    this.controls.rotateUp(upRad);
    this.controls.update();
  }

  /** Above 1 it becomes larger. */
  zoom(factor: number): void {
    this.controls.dollyIn(factor);
    this.controls.update();
  }

  render(): void {
    this.renderer.render(this.scene, this.camera);
  }

  /** Pixels from the upper left corner. */
  pixelOf(place: Place3): readonly [number, number] {
    const at = new Vector3(...this.raised(place)).project(this.camera);
    return [((at.x + 1) / 2) * this.size.x, ((1 - at.y) / 2) * this.size.y];
  }

  private raised([eastM, northM, upM]: Place3): Place3 {
    return [eastM, northM, upM * this.spread];
  }

  /** The building fits the shorter side of the window, however it is turned. */
  private frame(): void {
    const mPerPx = (2 * this.radiusM) / Math.min(this.size.x, this.size.y);
    const [halfX, halfY] = [(this.size.x * mPerPx) / 2, (this.size.y * mPerPx) / 2];
    Object.assign(this.camera, { left: -halfX, right: halfX, top: halfY, bottom: -halfY });
    Object.assign(this.camera, { near: -20 * this.radiusM, far: 20 * this.radiusM });
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }
}

function floorObjects(one: StackedFloor, { colours, shown, spread }: StackLook): (Mesh | LineSegments2)[] {
  const standsOut = one.floor === shown;
  const opacity = shown === "all" || standsOut ? 1 : FAINT;
  const heightM = one.heightM * spread;
  const at = (ring: readonly Corner[]) => ring.map(([east = 0, north = 0]): Place3 => [east, north, heightM]);
  const border = standsOut ? colours.chosen : colours.wall;
  const widthPx = standsOut ? STANDING_OUT_PX : WALL_PX;
  return [
    ...one.slabs.map((rings) => area(rings, heightM, colours.room, one.expected ? FAINT / 2 : FAINT)),
    ...one.stairs.map((rings) => area(rings, heightM, colours.stairs, opacity)),
    ...lines(one.lines.map(at), border, widthPx, one.expected ? FAINT : opacity),
    ...lines(one.doors.map(at), colours.room, 2 * WALL_PX, opacity),
  ];
}

function area(rings: readonly Corner[][], heightM: number, color: string, opacity: number): Mesh {
  const [outer = [], ...holes] = rings.map((ring) => ring.map(([east = 0, north = 0]) => new Vector2(east, north)));
  const shape = new Shape(outer);
  shape.holes = holes.map((hole) => new Path(hole));
  // Floors are seen through each other: what is nearer hides nothing.
  const material = new MeshBasicMaterial({ color, opacity, transparent: true, depthWrite: false, side: DoubleSide });
  const mesh = new Mesh(new ShapeGeometry(shape), material);
  mesh.position.z = heightM;
  return mesh;
}

/** One object for all; none without a line. */
function lines(paths: readonly (readonly Place3[])[], color: string, linewidth: number, opacity: number) {
  const ends = paths.flatMap((path) => path.slice(1).flatMap((place, i) => [...(path[i] ?? place), ...place]));
  if (ends.length === 0) return [];
  const material = new LineMaterial({ color, linewidth, opacity, transparent: opacity < 1, depthWrite: false });
  return [new LineSegments2(new LineSegmentsGeometry().setPositions(ends), material)];
}

function empty(group: Group): void {
  for (const child of [...group.children]) {
    if (!(child instanceof Mesh)) continue;
    child.geometry.dispose();
    (child.material as MeshBasicMaterial | LineMaterial).dispose();
  }
  group.clear();
}
