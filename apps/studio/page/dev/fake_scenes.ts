import type { GalleryEntry, Material, Scene } from '../src/protocol';

export const presets: Record<string, Material> = {
    cotton: { density: 472.6, youngs_modulus: 8e5, poisson_ratio: 0.243, thickness: 3e-4, bending: 'hinge', bending_scale: 1, law: 'isotropic', strain_limit: null },
    denim: { density: 680, youngs_modulus: 4e6, poisson_ratio: 0.25, thickness: 7e-4, bending: 'hinge', bending_scale: 1, law: 'isotropic', strain_limit: null },
    rubber: { density: 930, youngs_modulus: 1.5e6, poisson_ratio: 0.49, thickness: 5e-4, bending: 'hinge', bending_scale: 1, law: 'isotropic', strain_limit: null },
    steel: { density: 7850, youngs_modulus: 2.1e11, poisson_ratio: 0.3, thickness: 5e-4, bending: 'hinge', bending_scale: 1, law: 'isotropic', strain_limit: null },
};

export const live = [
    '/bodies/*/material', '/bodies/*/pressure', '/gravity', '/contact/friction', '/solve/time_step', '/solve/duration',
    '/handles/*/motion', '/obstacles/*/motion',
];

function scene(name: string, body: string, ball: boolean): Scene {
    return {
        name,
        bodies: [{ name: body, material: { ...presets.cotton! }, pressure: 0 }],
        obstacles: ball ? [{ name: 'ball', motion: [] }] : [],
        handles: ball ? [{ name: 'crown', body, axes: 'xz', motion: [] }] : [],
        loads: ball ? [{ body, select: { vertices: [0] }, force: [0, 0, 0] }] : [],
        gravity: [0, ball ? -9.81 : 0, 0],
        contact: { distance: 2e-3, thickness: 0, friction: 0.2 },
        hierarchy: { levels: 4, coarsest_vertices: 500, source: 'decimation', operator: 'shell', bending_on: 'level' },
        solve: { method: 'progressive', time_step: 0.05, duration: 2, tolerance: 1e-3 },
    };
}

export function sceneOf(id: string): Scene {
    return id === 'balloon' ? scene('balloon', 'balloon', false) : scene(id, 'cloth', true);
}

const titles: [string, string, string][] = [
    ['drape', 'Drape', 'A sheet of felt falls over a ball.'],
    ['balloon', 'Balloon', 'Pressure brings a dented balloon back.'],
    ['can_crush', 'Can', 'A drinks can, crushed from above.'],
    ['cloth_twist', 'Twist', 'A cloth wrung by both its ends.'],
    ['dome_inversion', 'Dome', 'A dome pushed until it turns inside out.'],
    ['pumpkin_press', 'Pumpkin', 'A soft pumpkin between two plates.'],
    ['cookie_cutter', 'Cookie cutter', 'A thin wall pressed into a shape.'],
    ['plate_buckling', 'Plate', 'A plate that buckles under its own edges.'],
];

export const pictures: Record<string, string> = { drape: 'sheet_drape', balloon: 'bubble_balloon' };

export const gallery: GalleryEntry[] = titles.map(([id, title, words]) => ({
    id, title, words, picture: `/api/gallery/${id}.png`, vertices: id === 'balloon' ? 12290 : 19881, levels: 4,
}));
