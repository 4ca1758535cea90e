"""Types of gatelight. help() of each name explains it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, TypedDict

import numpy
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Buffer, Unpack

__version__: str

Value = bool | int | float | str | PathLike[str] | Sequence[Any] | Mapping[str, Any] | range | None
Path = str | PathLike[str]
Triple = float | Sequence[float]
Floats = NDArray[numpy.float32]

class Options(TypedDict, total=False):
    """The flags of `gatelight render`."""

    output: Value
    exr: Value
    exposure: Value
    white_balance: Value
    tonemap: Value
    bits: Value
    ocio: Value
    ocio_display: Value
    ocio_view: Value
    skip_existing: Value
    reproducible: Value
    stats: Value
    quiet: Value
    verbose: Value
    checkpoint: Value
    checkpoint_every: Value
    resume: Value
    cache_in: Value
    cache_out: Value
    region: Value
    time_limit: Value
    max_error: Value
    seed: Value
    sampler: Value
    filter: Value
    filter_width: Value
    denoiser: Value
    prefilter: Value
    supersampling: Value
    temporal: Value
    oidn: Value
    aov: Value
    cryptomatte: Value
    light_groups: Value
    camera: Value
    eye: Value
    target: Value
    up: Value
    view_file: Value
    fov: Value
    lens: Value
    projection: Value
    view_height: Value
    aperture: Value
    focus: Value
    blades: Value
    environment: Value
    sky: Value
    background: Value
    shadow_catcher: Value
    environment_rotation: Value
    environment_scale: Value
    scene_index: Value
    variant: Value
    time: Value
    animation: Value
    show_hidden: Value
    backfaces: Value
    lights: Value
    ies: Value
    missing: Value
    allow_external: Value
    ignore_required: Value
    frames: Value
    fps: Value
    turntable: Value
    shutter: Value
    frame_groups: Value
    integrator: Value
    max_depth: Value
    max_transmission_depth: Value
    min_depth: Value
    direct: Value
    mis: Value
    light_selection: Value
    glass_shadows: Value
    watertight: Value
    ao_distance: Value
    clamp: Value
    nan: Value
    train_steps: Value
    train_time: Value
    batch: Value
    train_path_length: Value
    samples_per_point: Value
    training_points: Value
    samples_from_step: Value
    candidates: Value
    self_training: Value
    self_training_vertices: Value
    self_training_full: Value
    self_training_attenuation: Value
    learning_rate: Value
    learning_decay: Value
    loss: Value
    update: Value
    feature_step: Value
    average: Value
    encoding: Value
    features: Value
    stack: Value
    resolution: Value
    resolution_scale: Value
    node_spacing: Value
    max_resolution: Value
    cluster: Value
    storage: Value
    hash_levels: Value
    hash_features: Value
    hash_log2_size: Value
    hash_base: Value
    hash_growth: Value
    cache_memory: Value
    feature_precision: Value
    hidden: Value
    layers: Value
    bias: Value
    direction_input: Value
    normal_input: Value
    albedo_input: Value
    scout: Value
    cache_holds: Value
    query_at: Value
    view: Value
    cache_roughness: Value
    spread_threshold: Value
    query_precision: Value
    device: Value
    threads: Value
    memory_limit: Value
    isa: Value

class Error(Exception):
    option: str | None
    value: str | None
    expected: str | None
    code: int

class Texture:
    @property
    def index(self) -> int: ...

class Material:
    @property
    def index(self) -> int: ...
    name: str
    base_color: tuple[float, float, float]
    base_alpha: float
    base_color_texture: Texture | None
    metallic: float
    roughness: float
    metallic_roughness_texture: Texture | None
    normal_texture: Texture | None
    normal_scale: float
    emission: tuple[float, float, float]
    emission_texture: Texture | None
    alpha_mode: str
    alpha_cutoff: float
    double_sided: bool
    unlit: bool
    ior: float
    specular: float
    specular_texture: Texture | None
    specular_color: tuple[float, float, float]
    specular_color_texture: Texture | None
    transmission: float
    transmission_texture: Texture | None
    thickness: float
    attenuation_distance: float
    attenuation_color: tuple[float, float, float]
    dispersion: float
    anisotropy: float
    anisotropy_rotation: float
    anisotropy_texture: Texture | None
    iridescence: float
    iridescence_texture: Texture | None
    film_ior: float
    film_thickness_minimum: float
    film_thickness_maximum: float
    film_thickness_texture: Texture | None
    clearcoat: float
    clearcoat_texture: Texture | None
    clearcoat_roughness: float
    clearcoat_roughness_texture: Texture | None
    clearcoat_normal_texture: Texture | None
    clearcoat_normal_scale: float
    diffuse_transmission: float
    diffuse_transmission_texture: Texture | None
    diffuse_transmission_color: tuple[float, float, float]
    diffuse_transmission_color_texture: Texture | None
    sheen_color: tuple[float, float, float]
    sheen_color_texture: Texture | None
    sheen_roughness: float
    sheen_roughness_texture: Texture | None

class Mesh:
    @property
    def index(self) -> int: ...
    name: str
    positions: Floats
    normals: Floats | None
    uvs: Floats | None
    colors: Floats | None
    @property
    def triangles(self) -> NDArray[numpy.uint32]: ...
    material: Material | None

class Instance:
    @property
    def index(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def mesh(self) -> Mesh: ...
    transform: Floats
    dielectric_priority: float

class Light:
    @property
    def index(self) -> int: ...
    @property
    def type(self) -> str: ...
    name: str
    intensity: Triple
    position: tuple[float, float, float]
    direction: tuple[float, float, float]
    range: float
    inner_angle: float
    outer_angle: float

class Camera:
    @property
    def index(self) -> int: ...
    name: str
    transform: Floats
    fov: float
    view_height: float | None

class Scene:
    def __init__(self) -> None: ...
    def add_material(self, **members: Any) -> Material: ...
    def add_texture(self, image: ArrayLike, *, wrap: str = "repeat", nearest: bool = False, name: str = "") -> Texture: ...
    def add_mesh(
        self, positions: ArrayLike, triangles: ArrayLike, normals: ArrayLike | None = None, uvs: ArrayLike | None = None,
        material: Material | None = None, name: str = "", colors: ArrayLike | None = None,
    ) -> Mesh: ...
    def add_instance(self, mesh: Mesh, transform: ArrayLike | None = None, name: str = "") -> Instance: ...
    def add_light(self, type: str, **members: Any) -> Light: ...
    def add_camera(self, **members: Any) -> Camera: ...
    def show(self, seconds: float) -> None: ...
    @property
    def materials(self) -> list[Material]: ...
    @property
    def meshes(self) -> list[Mesh]: ...
    @property
    def instances(self) -> list[Instance]: ...
    @property
    def lights(self) -> list[Light]: ...
    @property
    def cameras(self) -> list[Camera]: ...
    @property
    def textures(self) -> list[Texture]: ...
    @property
    def path(self) -> str: ...
    @property
    def variants(self) -> list[str]: ...
    @property
    def animations(self) -> list[tuple[str, float]]: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def triangles(self) -> int: ...
    @property
    def bounds(self) -> Floats | None: ...
    @property
    def origin(self) -> tuple[float, float, float]: ...

class Picture(Buffer):
    def __getitem__(self, name: str) -> Floats: ...
    def __contains__(self, name: str) -> bool: ...
    @property
    def layers(self) -> dict[str, Floats]: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def metadata(self) -> dict[str, str]: ...
    @property
    def statistics(self) -> dict[str, Any]: ...
    def display(self, **options: Value) -> NDArray[numpy.uint8]: ...
    def save(self, path: Path, **options: Value) -> None: ...

class Renderer:
    def __init__(self, scene: Scene, **options: Value) -> None: ...
    def render(
        self, *, progress: Callable[[dict[str, Any]], object] | None = None, stop: Callable[[], bool] | None = None
    ) -> Picture: ...
    def set_camera(self, **view: Value) -> None: ...
    def set_options(self, **options: Value) -> None: ...
    def stop(self) -> None: ...
    @property
    def scene(self) -> Scene: ...

class Frames(Iterator[Picture]):
    def __len__(self) -> int: ...
    def __next__(self) -> Picture: ...

class Points:
    instances: NDArray[numpy.uint32]
    triangles: NDArray[numpy.uint32]
    barycentrics: Floats
    positions: Floats | None
    normals: Floats | None
    def __init__(
        self, instances: ArrayLike, triangles: ArrayLike, barycentrics: ArrayLike, positions: ArrayLike | None = None,
        normals: ArrayLike | None = None,
    ) -> None: ...
    def __len__(self) -> int: ...

class Cache:
    def __init__(self, scene: Scene | Mesh, encoding: str = "gate", outputs: int = 3, **options: Value) -> None: ...
    def train(
        self, points: Points, targets: ArrayLike, steps: int = 256, *, seed: int = 0,
        stop: Callable[[], bool] | None = None,
    ) -> NDArray[numpy.float64]: ...
    def query(self, points: Points) -> Floats: ...
    def save(self, path: Path) -> None: ...
    @staticmethod
    def load(path: Path, scene: Scene | Mesh) -> Cache: ...
    @property
    def outputs(self) -> int: ...
    @property
    def bytes(self) -> int: ...
    @property
    def steps(self) -> int: ...

def load(path: Path, **options: Value) -> Scene: ...
def read(path: Path) -> Picture: ...
def options() -> dict[str, dict[str, Any]]: ...
def render(
    scene: Scene | Path, size: tuple[int, int] | str = (960, 540), preset: str | None = "standard",
    spp: int | str | None = None, *, progress: Callable[[dict[str, Any]], object] | None = None,
    stop: Callable[[], bool] | None = None, **options: Unpack[Options],
) -> Picture: ...
def frames(
    scene: Scene | Path, size: tuple[int, int] | str = (960, 540), preset: str | None = "standard",
    spp: int | str | None = None, *, progress: Callable[[dict[str, Any]], object] | None = None,
    stop: Callable[[], bool] | None = None, **options: Unpack[Options],
) -> Frames: ...
def denoise(
    color: Picture | Path | ArrayLike, albedo: ArrayLike | None = None, normal: ArrayLike | None = None, **options: Value
) -> Picture: ...
def compare(
    reference: Picture | Path | ArrayLike, test: Picture | Path | ArrayLike,
    metric: str | Sequence[str] = ("flip", "ssim", "rel_mse"), exposure: float | str = 0.0, tonemap: str = "none",
) -> dict[str, float]: ...
def sample_points(scene_or_mesh: Scene | Mesh, count: int, seed: int | None = None) -> Points: ...
