// The mesh that is shown. Its arrays are kept while the version stays: positions are copied in, normals and colours
// computed in place.

import {
    BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Group, LineBasicMaterial, LineSegments, Mesh,
    MeshStandardMaterial,
} from 'three';

import type { MeshMessage, PositionsMessage } from '../binary';
import { colorScalars } from './colormap';
import { vertexNormals } from './normals';
import type { Palette } from './palette';
import type { FaceGroup } from './topology';
import { edgesOf, enclosedVolume, hasSharpEdges, isClosed, sortedByPart } from './topology';

export type PartKind = 'body' | 'obstacle';

export class Surface {
    readonly group = new Group();
    readonly mesh: MeshMessage;
    /** Faces sorted by part. */
    readonly corners: Uint32Array;
    readonly positions: Float32Array;
    private readonly groups: FaceGroup[];
    private readonly normals: Float32Array;
    private readonly colors: Float32Array;
    private readonly geometry = new BufferGeometry();
    private readonly materials: MeshStandardMaterial[];
    private readonly edgeMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.45 });
    private edges: LineSegments | null = null;
    private isColored = false;
    private hasPositions = false;
    private readonly closed: FaceGroup[];

    constructor(
        mesh: MeshMessage,
        private readonly kinds: readonly PartKind[],
        private palette: Palette,
    ) {
        this.mesh = mesh;
        const sorted = sortedByPart(mesh);
        this.corners = sorted.corners;
        this.groups = sorted.groups;
        this.positions = new Float32Array(mesh.vertices * 3);
        this.normals = new Float32Array(mesh.vertices * 3);
        this.colors = new Float32Array(mesh.vertices * 3);
        for (const [name, array] of [['position', this.positions], ['normal', this.normals], ['color', this.colors]] as const)
            this.geometry.setAttribute(name, new BufferAttribute(array, 3).setUsage(DynamicDrawUsage));
        this.geometry.setIndex(new BufferAttribute(this.corners, 1));
        this.materials = this.groups.map(() => new MeshStandardMaterial({
            side: DoubleSide, roughness: 0.72, metalness: 0, polygonOffset: true, polygonOffsetFactor: 1,
            polygonOffsetUnits: 1,
        }));
        this.groups.forEach((part, i) => this.geometry.addGroup(part.start, part.count, i));
        this.closed = this.groups.filter(
            (part) => this.kindOf(part.part) === 'body' && isClosed(this.corners, mesh.vertices, part),
        );
        this.add(new Mesh(this.geometry, this.materials), true);
        if (mesh.marked.length > 0) this.addMarkedFaces();
        this.applyPalette(palette);
    }

    kindOf(part: number): PartKind {
        return this.kinds[part] ?? 'body';
    }

    /** The part whose face begins at this place of `corners`. */
    partAt(corner: number): number {
        return this.groups.find((part) => corner < part.start + part.count)?.part ?? 0;
    }

    update(message: PositionsMessage): void {
        this.positions.set(message.positions);
        vertexNormals(this.positions, this.corners, this.normals);
        this.geometry.getAttribute('position').needsUpdate = true;
        this.geometry.getAttribute('normal').needsUpdate = true;
        if (message.scalars) {
            colorScalars(message.scalars, message.low, message.high, this.colors);
            this.geometry.getAttribute('color').needsUpdate = true;
        }
        this.setColored(message.scalars !== null);
        if (!this.hasPositions) this.shadeSharpObstaclesFlat();
        this.hasPositions = true;
    }

    /** Cubic metres that the closed bodies enclose; null where there is none. */
    volume(): number | null {
        if (this.closed.length === 0) return null;
        return this.closed.reduce((sum, part) => sum + enclosedVolume(this.corners, this.positions, part), 0);
    }

    showEdges(shown: boolean): void {
        if (shown && !this.edges) {
            const lines = new BufferGeometry();
            lines.setAttribute('position', this.geometry.getAttribute('position'));
            lines.setIndex(new BufferAttribute(edgesOf(this.corners, this.mesh.vertices), 1));
            this.edges = new LineSegments(lines, this.edgeMaterial);
            this.add(this.edges, false);
        }
        if (this.edges) this.edges.visible = shown;
    }

    applyPalette(palette: Palette): void {
        this.palette = palette;
        this.edgeMaterial.color.copy(palette.edge);
        this.paint();
    }

    dispose(): void {
        this.geometry.dispose();
        this.edges?.geometry.dispose();
        this.edgeMaterial.dispose();
        for (const material of this.materials) material.dispose();
    }

    private add(object: Mesh | LineSegments, castsShadow: boolean): void {
        // The arrays change under the geometry, so that a bounding sphere kept for culling would be wrong.
        object.frustumCulled = false;
        object.castShadow = castsShadow;
        object.receiveShadow = castsShadow;
        this.group.add(object);
    }

    private addMarkedFaces(): void {
        const marked = new BufferGeometry();
        for (const name of ['position', 'normal']) marked.setAttribute(name, this.geometry.getAttribute(name));
        const index = new Uint32Array(this.mesh.marked.length * 3);
        this.mesh.marked.forEach((face, i) => index.set(this.mesh.corners.subarray(face * 3, face * 3 + 3), i * 3));
        marked.setIndex(new BufferAttribute(index, 1));
        this.add(new Mesh(marked, new MeshStandardMaterial({
            color: this.palette.marked, emissive: this.palette.marked, emissiveIntensity: 0.35, side: DoubleSide,
            depthTest: false, transparent: true, opacity: 0.85,
        })), false);
    }

    private setColored(colored: boolean): void {
        if (colored === this.isColored) return;
        this.isColored = colored;
        this.paint();
    }

    private paint(): void {
        let bodies = 0;
        this.groups.forEach((part, i) => {
            const isBody = this.kindOf(part.part) === 'body';
            const own = isBody ? this.palette.bodies[bodies++ % this.palette.bodies.length]! : this.palette.obstacle;
            const material = this.materials[i]!;
            material.roughness = isBody ? 0.68 : 0.95;
            const usesScalars = this.isColored && isBody;
            if (usesScalars) material.color.set(0xffffff);
            else material.color.copy(own);
            if (material.vertexColors !== usesScalars) {
                material.vertexColors = usesScalars;
                material.needsUpdate = true;
            }
        });
    }

    private shadeSharpObstaclesFlat(): void {
        this.groups.forEach((part, i) => {
            if (this.kindOf(part.part) !== 'obstacle') return;
            const own = this.corners.subarray(part.start, part.start + part.count);
            if (!hasSharpEdges(own, this.positions)) return;
            this.materials[i]!.flatShading = true;
            this.materials[i]!.needsUpdate = true;
        });
    }
}
