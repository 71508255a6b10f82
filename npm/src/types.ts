/** What callers give and get. Names and defaults are those of the program and of Python. */

/** A length in the mesh's unit, or with `%` a part of the diagonal of the mesh's bounding box. */
export type Length = number | string;

/** A whole number; as a text it may be written "20k", "1.5M", "2e4" or "20,000". */
export type Count = number | string;

export type Boundary = 'smooth' | 'corners' | 'fixed';
export type Scheme = 'loop' | 'loop-warren' | 'butterfly' | 'catmull-clark';
export type ConcaveCorners = 'divided' | 'as-tagged';
export type Precision = 'f32' | 'f64';

export type Domain = 'vertex' | 'corner' | 'face';
export type Semantic = 'texture' | 'colour' | 'skin-weight' | 'displacement' | 'label' | 'other';
export type Interpolation =
  | 'linear'
  | 'nearest'
  | 'smooth-none'
  | 'smooth-corners-only'
  | 'smooth-corners-plus1'
  | 'smooth-corners-plus2'
  | 'smooth-boundaries';

export type FloatArray = Float32Array<ArrayBuffer> | Float64Array<ArrayBuffer>;
/** Numbers: any typed array of numbers, or a plain one. */
export type Numbers = ArrayLike<number>;

/** What a mesh carries: a table of values, and for each vertex, corner or face which of them it has. */
export interface Channel {
  name: string;
  /** Values, `components` numbers each. */
  data: Numbers;
  components: number;
  /** By element of the domain the row of its value; without it each element has the row of its own number. */
  index?: Numbers | null;
  /** What the elements are. Default: `'vertex'`. Corners are numbered as in the mesh's index. */
  domain?: Domain;
  /** What the values mean. Default: `'other'`. */
  semantic?: Semantic;
  /** Default: texture coordinates `'smooth-boundaries'`, skins and displacements `'smooth-none'`, labels `'nearest'`, all else `'linear'`. */
  interpolation?: Interpolation;
}

/** A channel of a result. Two corners at one vertex that name different rows have a seam between them. */
export interface RefinedChannel {
  name: string;
  /** Values, `components` numbers each. */
  data: FloatArray;
  components: number;
  /** By element of the domain, the row of its value. */
  index: Uint32Array<ArrayBuffer>;
  domain: Domain;
}

/** How far a call has come. */
export interface Progress {
  /** What is being done, in words. */
  stage: string;
  /** Units of this stage that are done. */
  done: number;
  /** Units that there will be, where that is known. */
  total: number | null;
  /** Of the mesh that is being made. */
  triangles: number;
}

/** An edge with its ends and its sharpness in levels; without one it is sharp for ever. */
export type Crease = readonly [a: number, b: number, sharpness?: number];
/** A vertex that stays, or one with its sharpness in levels. */
export type Corner = number | readonly [vertex: number, sharpness: number];

/** How a control mesh comes of a mesh, and its limit surface of that. */
export interface SurfaceOptions {
  /** Corners of a face: 3 for triangles, 4 for quads. Default: 3. */
  faceSize?: number;
  /** Lets the limit surface pass through the vertices; a length lets it pass that near to them, and be as fair as it can. Default: false. */
  interpolate?: boolean | Length | null;
  /** Edges stay sharp where faces meet at more degrees. Default: none. */
  creaseAngle?: number | null;
  /** Edges that stay sharp; `'auto'` finds those of parts, and leads their surface through the vertices where that does not fold it. */
  creases?: readonly Crease[] | 'auto' | null;
  /** Vertices that stay. */
  corners?: readonly Corner[] | null;
  /** `'corners'` keeps vertices in one face only, `'fixed'` open boundaries as they are. Default: `'smooth'`. */
  boundary?: Boundary;
  /** Corners of 180° and more between sharp edges. Default: divided with creases that are found and boundaries that are not smooth. */
  concaveCorners?: ConcaveCorners | null;
  /** Default: `'catmull-clark'` for quads, else `'loop'`. */
  scheme?: Scheme | null;
  /** OpenSubdiv's rule for triangles in cages for `'catmull-clark'`. Default: false. */
  smoothTriangles?: boolean;
  /** Distance within which vertices become one: 0 for equal positions, null for none. Default: 0. */
  weld?: number | null;
  /** Whether defects are mended, and told of in `diagnosis`, or refused. Default: true. */
  repair?: boolean;
  /** Of positions in results. Default: that of the positions given. */
  precision?: Precision;
  /** Is told some twenty times a second how far the call has come; one that returns false ends it. */
  onProgress?: ((progress: Progress) => unknown) | null;
}

/** What is asked of a refinement. Without a goal the tolerance is "0.1%". */
export interface Options extends SurfaceOptions {
  /** Greatest distance between mesh and limit surface, either way. */
  tolerance?: Length | null;
  /** The best mesh with at most so many triangles. */
  triangles?: Count | null;
  /** Greatest angle between triangles and limit normals, in degrees. */
  angle?: number | null;
  /** Collapses edges of a finer mesh as long as the goals allow: slower, with fewer triangles. Default: false. */
  optimize?: boolean;
  /** Lets vertices leave the limit surface by up to half the local error: fewer triangles. Default: false. */
  balance?: boolean;
  /** Whether regions in a plane are triangulated from their rims alone. Default: true. */
  flatRegions?: boolean;
  /** What is carried along. */
  channels?: readonly Channel[] | null;
  /** Caps; what was reached by then is the result, and `stop` says so. */
  maxTriangles?: Count | null;
  /** At most 30. Default: 24. */
  maxLevels?: number | null;
  /** In bytes, or such as "500MB"; at most 3.5 GiB. Default: "1GB". */
  maxMemory?: number | string | null;
}

/** What only calls in a worker take. */
export interface WorkerOptions {
  /** Ends the call at once; it rejects with the signal's reason. */
  signal?: AbortSignal | null;
  /** A worker that runs `limitmesh/worker`, for pages whose rules forbid workers from texts. Calls on one worker wait for each other. It is
   * ended with a call that is ended, and refused by later ones; one that you terminate yourself never answers. */
  worker?: Worker | null;
}

/**
 * Why a refinement ended. `'rounding'`: numbers are too coarse for the tolerance, those of the reckoning or those of the result, which are
 * rounded to 32 bits.
 */
export type Stop = 'met' | 'triangles' | 'triangle-cap' | 'level-cap' | 'memory-cap' | 'rounding' | 'cones' | 'other';

/** What was found in the input. */
export interface Diagnosis {
  /** Whether there was no defect. */
  clean: boolean;
  /** A line for each kind of defect, with its repair. */
  repairs: string[];
  /** A line for each finding that is no defect, with its treatment. */
  preparations: string[];
  /** How many of each kind, and the numbers of the first few in the input. */
  findings: Record<string, { count: number; first: number[] }>;
}

/** A refined mesh: a plain object whose arrays are its own. */
export interface Refined {
  /** Three numbers a vertex. */
  positions: FloatArray;
  /** Three vertices a triangle. */
  index: Uint32Array<ArrayBuffer>;
  /** Limit normals, three numbers a vertex; at sharp edges an average of the sides. */
  normals: Float32Array<ArrayBuffer>;
  /** Corners of triangles at sharp edges, numbered as in `index`, and the limit normals of their own sides. */
  sides: { corners: Uint32Array<ArrayBuffer>; normals: Float32Array<ArrayBuffer> };
  /** By triangle, the face of the input that it came from. */
  parents: Uint32Array<ArrayBuffer>;
  /** In the order of the option. */
  channels: RefinedChannel[];
  /** The distance between mesh and limit surface is between these, where `certified` says so for sure; positions rounded to 32 bits are
   * reckoned with. */
  error: { lower: number; upper: number; certified: boolean };
  stop: Stop;
  /** Of the deepest part. */
  levels: number;
  /** Triangles that are turned over with regard to the limit surface. */
  inverted: number;
  /** In degrees, as asked for or found. */
  creaseAngle: number | null;
  diagnosis: Diagnosis;
}

/** Where the vertices of a mesh go on its limit surface. NaN for those in no face. */
export interface Limits {
  positions: FloatArray;
  /** Unit normals; at sharp edges an average of the sides. */
  normals: FloatArray;
}

/** A mesh that is measured. */
export interface MeshLike {
  positions: Numbers;
  index?: Numbers | null;
}

/** How a distance is found. */
export interface MeasureOptions extends Omit<SurfaceOptions, 'precision'> {
  /** Instead of a second mesh: the control mesh whose limit surface it is. */
  limitOf?: MeshLike | null;
  /** Bounds the distance from both sides, rather than sampling it. Default: false. */
  certified?: boolean;
  /** On each surface. Default: 100,000. */
  samples?: Count;
  /** How narrow a certified interval is to be. */
  gap?: Length | null;
  /** Work after which a certified search ends with what it has. */
  maxWork?: Count | null;
  /** Of uniform refinement that stands for a limit surface when sampling. Default: 5, or fewer for large meshes. */
  levels?: number | null;
}

/** The greatest distance from one surface to another. */
export interface OneSided {
  lower: number;
  /** Infinite where the distance is sampled. */
  upper: number;
  /** Of sampled distances. */
  mean?: number;
  rms?: number;
  percentile95?: number;
  samples?: number;
  /** The farthest point that was found, and the other surface's closest point to it. */
  at: [number, number, number];
  to: [number, number, number];
}

/** The symmetric Hausdorff distance of two surfaces, in their unit. */
export interface Distance {
  lower: number;
  upper: number;
  certified: boolean;
  /** Whether the interval is as narrow as was asked for. */
  converged: boolean;
  forward: OneSided;
  backward: OneSided;
  /** Of the second surface's bounding box. */
  diagonal: number;
}

/** Formats of files, by their extensions. */
export type Format = 'obj' | 'ply' | 'stl' | 'off' | 'gltf' | 'glb' | '3mf';

/** What is asked of the refinement of a file. Sharp edges are found by default, as in the program: `creases: 'auto'`. */
export interface FileOptions extends Omit<Options, 'faceSize' | 'channels' | 'precision' | 'corners' | 'creases'> {
  /** `'auto'` finds the sharp edges of parts where the file tags none; `'none'` keeps none but those that it tags. Default: `'auto'`. */
  creases?: 'auto' | 'none' | null;
}

/** A file that was refined. */
export interface RefinedFile {
  bytes: Uint8Array<ArrayBuffer>;
  report: FileReport;
}

export interface FileReport {
  /** One for each mesh of an asset, else one. */
  meshes: (Pick<Refined, 'error' | 'stop' | 'creaseAngle' | 'diagnosis'> & { name: string; triangles: number; vertices: number })[];
  /** Names of what could not be kept: values, and files of materials and pictures that the input names. */
  leftOut: string[];
}
