//! Embree 4, opened at run time: only what this bench asks of it.

use std::{
    env,
    ffi::{CStr, c_char, c_void},
    fs,
    path::{Path, PathBuf},
    ptr,
    sync::atomic::{AtomicI64, Ordering},
};

use glam::Vec3;
use libloading::Library;
use phong_bvh::{Hit, Primitives, Ray};

type Handle = *mut c_void;
type Intersect1 = unsafe extern "C" fn(Handle, *mut RayHit, *mut Arguments);
type Occluded1 = unsafe extern "C" fn(Handle, *mut RayOnly, *mut Arguments);
type Intersect8 = unsafe extern "C" fn(*const Mask8, Handle, *mut RayHit8, *mut Arguments);
type Occluded8 = unsafe extern "C" fn(*const Mask8, Handle, *mut Ray8, *mut Arguments);
type Monitor = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;

/// `RTCRay`.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
struct RayOnly {
    origin: [f32; 3],
    near: f32,
    dir: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

/// `RTCRayHit`; 96 bytes in this build, which has `instPrimID`.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
struct RayHit {
    ray: RayOnly,
    ng: [f32; 3],
    u: f32,
    v: f32,
    prim: u32,
    geometry: u32,
    instance: u32,
    instance_prim: u32,
}

/// `RTCRay8`.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Ray8 {
    origin: [[f32; 8]; 3],
    near: [f32; 8],
    dir: [[f32; 8]; 3],
    time: [f32; 8],
    far: [f32; 8],
    mask: [u32; 8],
    id: [u32; 8],
    flags: [u32; 8],
}

/// `RTCRayHit8`.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct RayHit8 {
    ray: Ray8,
    ng: [[f32; 8]; 3],
    u: [f32; 8],
    v: [f32; 8],
    prim: [u32; 8],
    geometry: [u32; 8],
    instance: [u32; 8],
    instance_prim: [u32; 8],
}

#[repr(C, align(32))]
struct Mask8([i32; 8]);

/// `RTCIntersectArguments` and `RTCOccludedArguments`, with room for their optional last field.
#[repr(C)]
struct Arguments {
    flags: u32,
    features: u32,
    context: Handle,
    filter: Handle,
    callback: Handle,
    min_width: [f32; 4],
}

const COHERENT: u32 = 1 << 16;
const NONE: u32 = u32::MAX;

impl Arguments {
    const fn new(flags: u32) -> Self {
        let null = ptr::null_mut();
        let min_width = [0.0; 4];
        Self { flags, features: u32::MAX, context: null, filter: null, callback: null, min_width }
    }
}

/// How Embree is to build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flavour {
    Default,
    Robust,
    Compact,
}

/// How Embree is to be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    One,
    Eight { coherent: bool },
}

/// The Embree library: as told, or in the virtual environment `setup.sh` made.
pub(crate) fn find(folder: &Path) -> Option<PathBuf> {
    if let Some(path) = env::var_os("PHONG_EMBREE") {
        return Some(path.into());
    }
    let inside = |folder: PathBuf, start: &str| {
        let entries = fs::read_dir(folder).ok()?;
        let fits = |name: &str| name.starts_with(start);
        entries.flatten().find(|e| e.file_name().to_str().is_some_and(fits)).map(|e| e.path())
    };
    let packages = inside(folder.join("venv/lib"), "python")?.join("site-packages");
    inside(packages.join("embreex.libs"), "libembree4")
}

/// The library, and a device for one thread.
pub(crate) struct Embree {
    library: Library,
    device: Handle,
}

/// What Embree holds allocated.
static BYTES: AtomicI64 = AtomicI64::new(0);

unsafe extern "C" fn count(_: *mut c_void, bytes: isize, _: bool) -> bool {
    BYTES.fetch_add(bytes as i64, Ordering::Relaxed);
    true
}

impl Embree {
    /// Opens the library at `path`.
    pub(crate) fn open(path: &Path) -> Result<Self, libloading::Error> {
        // SAFETY: Embree's initialisers set up nothing but itself.
        let library = unsafe { Library::new(path)? };
        let threads: &CStr = c"threads=1";
        // SAFETY: the signatures are those of Embree 4's header.
        let device = unsafe {
            let new =
                library.get::<unsafe extern "C" fn(*const c_char) -> Handle>("rtcNewDevice")?;
            let monitor = library.get::<unsafe extern "C" fn(Handle, Monitor, *mut c_void)>(
                "rtcSetDeviceMemoryMonitorFunction",
            )?;
            let device = new(threads.as_ptr());
            monitor(device, count, ptr::null_mut());
            device
        };
        Ok(Self { library, device })
    }

    /// The function `name`, which the caller knows the type of.
    fn function<F: Copy>(&self, name: &str) -> F {
        // SAFETY: every `F` here is written after Embree 4's header.
        let symbol = unsafe { self.library.get::<F>(name) };
        *symbol.unwrap_or_else(|error| panic!("Embree without {name}: {error}"))
    }

    /// Builds a scene of one batch of primitives; `arrays` must have been made from it.
    pub(crate) fn build<'e>(&'e self, arrays: &'e Arrays, flavour: Flavour) -> EmbreeScene<'e> {
        let before = BYTES.load(Ordering::Relaxed);
        let new_scene = self.function::<unsafe extern "C" fn(Handle) -> Handle>("rtcNewScene");
        let set_flags = self.function::<unsafe extern "C" fn(Handle, u32)>("rtcSetSceneFlags");
        let new_geometry =
            self.function::<unsafe extern "C" fn(Handle, u32) -> Handle>("rtcNewGeometry");
        let attach =
            self.function::<unsafe extern "C" fn(Handle, Handle) -> u32>("rtcAttachGeometry");
        let [commit_geometry, release_geometry, commit_scene] =
            ["rtcCommitGeometry", "rtcReleaseGeometry", "rtcCommitScene"]
                .map(|name| self.function::<unsafe extern "C" fn(Handle)>(name));
        let scene_flags = match flavour {
            Flavour::Default => 0,
            Flavour::Compact => 1 << 1,
            Flavour::Robust => 1 << 2,
        };
        // SAFETY: the handles live as long as this scene; the buffers, borrowed, outlive it.
        let scene = unsafe {
            let scene = new_scene(self.device);
            set_flags(scene, scene_flags);
            let geometry = new_geometry(self.device, arrays.kind);
            arrays.share(self, geometry);
            commit_geometry(geometry);
            attach(scene, geometry);
            release_geometry(geometry);
            commit_scene(scene);
            scene
        };
        EmbreeScene {
            embree: self,
            scene,
            bytes: BYTES.load(Ordering::Relaxed) - before,
            intersect1: self.function("rtcIntersect1"),
            occluded1: self.function("rtcOccluded1"),
            intersect8: self.function("rtcIntersect8"),
            occluded8: self.function("rtcOccluded8"),
        }
    }
}

/// The user's own arrays, as Embree wants them: not counted in its memory, as in ours.
pub(crate) struct Arrays {
    kind: u32,
    /// Three a vertex, or four a sphere; and some more, since Embree reads 16 bytes at a time.
    vertices: Vec<f32>,
    indices: Vec<[u32; 3]>,
}

impl Arrays {
    pub(crate) fn of(geometry: &Primitives) -> Self {
        const TRIANGLE: u32 = 0;
        const SPHERE_POINT: u32 = 50;
        let (kind, mut vertices, indices) = match geometry {
            Primitives::Triangles { positions, indices } => {
                let vertices = positions.iter().flat_map(Vec3::to_array).collect::<Vec<_>>();
                (TRIANGLE, vertices, indices.to_vec())
            }
            Primitives::Spheres(spheres) => {
                (SPHERE_POINT, spheres.as_slice().as_flattened().to_vec(), Vec::new())
            }
            Primitives::Cylinders { .. } | Primitives::Plane(_) | Primitives::Solid(_) => {
                panic!("not asked of Embree")
            }
        };
        vertices.extend([0.0; 4]);
        Self { kind, vertices, indices }
    }

    /// Hands the arrays to `geometry` without a copy.
    ///
    /// # Safety
    /// They must live as long as the geometry.
    unsafe fn share(&self, embree: &Embree, geometry: Handle) {
        const INDEX: u32 = 0;
        const VERTEX: u32 = 1;
        const UINT3: u32 = 0x5003;
        const FLOAT3: u32 = 0x9003;
        const FLOAT4: u32 = 0x9004;
        let set = embree.function::<unsafe extern "C" fn(
            Handle,
            u32,
            u32,
            u32,
            *const c_void,
            usize,
            usize,
            usize,
        )>("rtcSetSharedGeometryBuffer");
        let (format, width) = if self.indices.is_empty() { (FLOAT4, 4) } else { (FLOAT3, 3) };
        let count = (self.vertices.len() - 4) / width;
        // SAFETY: sizes are those of the arrays; the caller keeps them alive.
        unsafe {
            let vertices = self.vertices.as_ptr().cast();
            set(geometry, VERTEX, 0, format, vertices, 0, 4 * width, count);
            if !self.indices.is_empty() {
                let indices = self.indices.as_ptr().cast();
                set(geometry, INDEX, 0, UINT3, indices, 0, 12, self.indices.len());
            }
        }
    }
}

/// A built scene.
pub(crate) struct EmbreeScene<'e> {
    embree: &'e Embree,
    scene: Handle,
    bytes: i64,
    intersect1: Intersect1,
    occluded1: Occluded1,
    intersect8: Intersect8,
    occluded8: Occluded8,
}

impl EmbreeScene<'_> {
    /// What the build left allocated.
    pub(crate) fn bytes(&self) -> i64 {
        self.bytes
    }

    /// The closest hit of every ray.
    pub(crate) fn intersect(&self, width: Width, rays: &[Ray], hits: &mut [Hit]) {
        match width {
            Width::One => {
                let mut arguments = Arguments::new(0);
                for (ray, hit) in rays.iter().zip(hits) {
                    let mut query = RayHit::of(ray);
                    // SAFETY: both structs are Embree's; the scene is committed.
                    unsafe { (self.intersect1)(self.scene, &raw mut query, &raw mut arguments) };
                    *hit = query.hit();
                }
            }
            Width::Eight { coherent } => {
                let mut arguments = Arguments::new(if coherent { COHERENT } else { 0 });
                for (rays, hits) in rays.chunks(8).zip(hits.chunks_mut(8)) {
                    let mut query = RayHit8::of(rays);
                    let valid = Mask8::of(rays.len());
                    let (valid, arguments) = (&raw const valid, &raw mut arguments);
                    // SAFETY: as above; lanes beyond the rays are not valid.
                    unsafe { (self.intersect8)(valid, self.scene, &raw mut query, arguments) };
                    for (lane, hit) in hits.iter_mut().enumerate() {
                        *hit = query.hit(lane);
                    }
                }
            }
        }
    }

    /// Whether each ray meets anything.
    pub(crate) fn occluded(&self, width: Width, rays: &[Ray], blocked: &mut [bool]) {
        match width {
            Width::One => {
                let mut arguments = Arguments::new(0);
                for (ray, blocked) in rays.iter().zip(blocked) {
                    let mut query = RayOnly::of(ray);
                    // SAFETY: both structs are Embree's; the scene is committed.
                    unsafe { (self.occluded1)(self.scene, &raw mut query, &raw mut arguments) };
                    *blocked = query.far < 0.0;
                }
            }
            Width::Eight { coherent } => {
                let mut arguments = Arguments::new(if coherent { COHERENT } else { 0 });
                for (rays, blocked) in rays.chunks(8).zip(blocked.chunks_mut(8)) {
                    let mut query = Ray8::of(rays);
                    let valid = Mask8::of(rays.len());
                    let (valid, arguments) = (&raw const valid, &raw mut arguments);
                    // SAFETY: as above; lanes beyond the rays are not valid.
                    unsafe { (self.occluded8)(valid, self.scene, &raw mut query, arguments) };
                    for (lane, blocked) in blocked.iter_mut().enumerate() {
                        *blocked = query.far[lane] < 0.0;
                    }
                }
            }
        }
    }
}

impl Drop for EmbreeScene<'_> {
    fn drop(&mut self) {
        let release = self.embree.function::<unsafe extern "C" fn(Handle)>("rtcReleaseScene");
        // SAFETY: the handle is this scene's own and is not used again.
        unsafe { release(self.scene) };
    }
}

impl RayOnly {
    fn of(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.as_vec3().to_array(),
            near: ray.t_min,
            dir: ray.dir.to_array(),
            time: 0.0,
            far: ray.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }
}

impl RayHit {
    fn of(ray: &Ray) -> Self {
        Self {
            ray: RayOnly::of(ray),
            ng: [0.0; 3],
            u: 0.0,
            v: 0.0,
            prim: NONE,
            geometry: NONE,
            instance: NONE,
            instance_prim: NONE,
        }
    }

    fn hit(&self) -> Hit {
        if self.geometry == NONE {
            return Hit::NONE;
        }
        Hit { t: self.ray.far, part: part(self.prim), prim: self.prim, u: self.u, v: self.v }
    }
}

impl Mask8 {
    fn of(rays: usize) -> Self {
        Self(std::array::from_fn(|lane| if lane < rays { -1 } else { 0 }))
    }
}

impl Ray8 {
    fn of(rays: &[Ray]) -> Self {
        let zero = [0.0; 8];
        let mut eight = Self {
            origin: [zero; 3],
            near: zero,
            dir: [zero; 3],
            time: zero,
            far: zero,
            mask: [u32::MAX; 8],
            id: [0; 8],
            flags: [0; 8],
        };
        for (lane, ray) in rays.iter().enumerate() {
            for axis in 0..3 {
                eight.origin[axis][lane] = ray.origin[axis] as f32;
                eight.dir[axis][lane] = ray.dir[axis];
            }
            eight.near[lane] = ray.t_min;
            eight.far[lane] = ray.t_max;
        }
        eight
    }
}

impl RayHit8 {
    fn of(rays: &[Ray]) -> Self {
        let (zero, none) = ([0.0; 8], [NONE; 8]);
        Self {
            ray: Ray8::of(rays),
            ng: [zero; 3],
            u: zero,
            v: zero,
            prim: none,
            geometry: none,
            instance: none,
            instance_prim: none,
        }
    }

    fn hit(&self, lane: usize) -> Hit {
        if self.geometry[lane] == NONE {
            return Hit::NONE;
        }
        let [u, v] = [self.u[lane], self.v[lane]];
        Hit { t: self.ray.far[lane], part: part(self.prim[lane]), prim: self.prim[lane], u, v }
    }
}

/// The part of our world that Embree's primitive is of: the only one, or none.
fn part(prim: u32) -> u32 {
    if prim == u32::MAX { u32::MAX } else { 0 }
}
