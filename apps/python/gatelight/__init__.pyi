"""Types of gatelight. help() of each name explains it."""
# The build adds Options, a dict of all options of `gatelight render`.

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
