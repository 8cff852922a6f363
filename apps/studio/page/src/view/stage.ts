// Light, ground, camera: what the surface stands in.

import {
    Box3, DirectionalLight, HemisphereLight, Mesh, PCFSoftShadowMap, PerspectiveCamera, PlaneGeometry, Scene,
    ShadowMaterial, Spherical, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import type { Palette } from './palette';

export class Stage {
    readonly scene = new Scene();
    readonly camera = new PerspectiveCamera(36, 1, 0.01, 100);
    readonly renderer: WebGLRenderer;
    readonly controls: OrbitControls;
    private readonly key = new DirectionalLight(0xfff4e6, 2.3);
    private readonly fill = new DirectionalLight(0xdfe8ff, 0.55);
    private readonly sky = new HemisphereLight(0xffffff, 0xb8b2a8, 1.15);
    private readonly ground = new Mesh(new PlaneGeometry(1, 1), new ShadowMaterial({ opacity: 0.2 }));
    private isDirty = true;

    constructor(private readonly host: HTMLElement) {
        this.renderer = new WebGLRenderer({ antialias: true, powerPreference: 'high-performance' });
        this.renderer.shadowMap.enabled = true;
        this.renderer.shadowMap.type = PCFSoftShadowMap;
        this.renderer.shadowMap.autoUpdate = false;
        host.append(this.renderer.domElement);
        this.key.castShadow = true;
        this.key.shadow.mapSize.set(1024, 1024);
        this.key.shadow.radius = 6;
        // What lies under a cloth should still be seen.
        this.key.shadow.intensity = 0.6;
        // No bias along normals: shells are lit from either side, whichever way their normals point.
        this.key.shadow.bias = -1.5e-3;
        this.ground.rotation.x = -Math.PI / 2;
        this.ground.receiveShadow = true;
        this.ground.visible = false;
        this.scene.add(this.sky, this.key, this.key.target, this.fill, this.ground);
        this.controls = new OrbitControls(this.camera, this.renderer.domElement);
        this.controls.enableDamping = true;
        this.controls.dampingFactor = 0.12;
        this.controls.addEventListener('change', () => this.invalidate());
        new ResizeObserver(() => this.resize()).observe(host);
        this.resize();
    }

    /** Turns the view, in radians, and moves the eye to `nearer` times its distance. */
    orbit(turn: number, tilt: number, nearer: number): void {
        const offset = this.camera.position.clone().sub(this.controls.target);
        const place = new Spherical().setFromVector3(offset);
        place.theta += turn;
        place.phi += tilt;
        place.radius = Math.min(this.controls.maxDistance, Math.max(this.controls.minDistance, place.radius * nearer));
        this.camera.position.setFromSpherical(place.makeSafe()).add(this.controls.target);
        this.controls.update();
        this.invalidate();
    }

    get groundHeight(): number {
        return this.ground.position.y;
    }

    invalidate(): void {
        this.isDirty = true;
    }

    /** After positions have changed: shadows too. */
    invalidateShadows(): void {
        this.renderer.shadowMap.needsUpdate = true;
        this.isDirty = true;
    }

    /** Draws if anything has changed; called once for each frame of the screen. */
    draw(): boolean {
        this.controls.update();
        if (!this.isDirty) return false;
        this.isDirty = false;
        this.renderer.render(this.scene, this.camera);
        return true;
    }

    applyPalette(palette: Palette, isDark: boolean): void {
        this.scene.background = palette.background;
        this.sky.groundColor.copy(palette.ground);
        this.sky.intensity = isDark ? 0.95 : 1.15;
        this.key.intensity = isDark ? 1.9 : 2.3;
        this.ground.material.opacity = isDark ? 0.42 : 0.16;
        this.invalidateShadows();
    }

    /** Puts light and ground around a box, and the camera before it when asked to. */
    frame(box: Box3, movesCamera: boolean): void {
        if (box.isEmpty()) return;
        const center = box.getCenter(new Vector3());
        const radius = Math.max(1e-6, box.getSize(new Vector3()).length() / 2);
        this.setLight(center, radius);
        this.ground.visible = true;
        this.ground.scale.setScalar(radius * 40);
        this.ground.position.set(center.x, box.min.y - 0.04 * radius, center.z);
        this.camera.near = radius * 0.01;
        this.camera.far = radius * 60;
        this.controls.minDistance = radius * 0.05;
        this.controls.maxDistance = radius * 20;
        if (movesCamera) {
            const distance = (1.12 * radius) / Math.sin((this.camera.fov * Math.PI) / 360);
            const direction = new Vector3(0.55, 0.42, 1).normalize();
            const narrow = Math.max(1, 1 / this.camera.aspect);
            // A little below the middle, so that the scene stands clear of the buttons at the bottom of the view.
            this.controls.target.copy(center).y -= 0.16 * radius;
            this.camera.position.copy(this.controls.target).addScaledVector(direction, distance * narrow);
        }
        this.camera.updateProjectionMatrix();
        this.invalidateShadows();
    }

    private setLight(center: Vector3, radius: number): void {
        this.key.position.copy(center).add(new Vector3(0.9, 2.1, 1.3).multiplyScalar(radius * 1.6));
        this.key.target.position.copy(center);
        this.fill.position.copy(center).add(new Vector3(-2, 0.6, 0.4).multiplyScalar(radius));
        const shadow = this.key.shadow.camera;
        shadow.left = shadow.bottom = -2 * radius;
        shadow.right = shadow.top = 2 * radius;
        shadow.near = 0.1 * radius;
        shadow.far = 9 * radius;
        shadow.updateProjectionMatrix();
    }

    private resize(): void {
        const { clientWidth: width, clientHeight: height } = this.host;
        if (width === 0 || height === 0) return;
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
        this.renderer.setSize(width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.invalidateShadows();
    }
}
