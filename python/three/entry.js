// The part of three.js that the page uses; `npm install && npm run build` makes ../src/kinefab/views/page/assets/three.min.js.
export {
  ACESFilmicToneMapping, AmbientLight, Box3, BoxGeometry, BufferAttribute, BufferGeometry, CircleGeometry, Color,
  ConeGeometry, CylinderGeometry, DirectionalLight, DoubleSide, Float32BufferAttribute, Fog, GridHelper, Group,
  HemisphereLight, InstancedMesh, Line, LineBasicMaterial, LineDashedMaterial, LineLoop, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, MeshLambertMaterial, MeshStandardMaterial, NoToneMapping, OrthographicCamera, PCFShadowMap,
  PCFSoftShadowMap, PerspectiveCamera, Plane, PlaneGeometry, Points, PointsMaterial, Quaternion, Raycaster, RingGeometry,
  SRGBColorSpace, Scene, ShadowMaterial, SphereGeometry, Sprite, SpriteMaterial, TorusGeometry, TubeGeometry, Vector2,
  Vector3, WebGLRenderer, CanvasTexture, REVISION,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
