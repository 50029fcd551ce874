/* What viewer.js takes of three.js; `bundle` makes three.min.js of it. */
export {
  Box3, BoxGeometry, BufferAttribute, BufferGeometry, Color, CylinderGeometry, DirectionalLight, DoubleSide, EdgesGeometry, Group,
  HemisphereLight, LatheGeometry, Line, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, OrthographicCamera, Raycaster,
  Scene, ShapeUtils, Vector2, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
