import { Actions, newGesture } from './actions';
import { dropLostColoring } from './colorings';
import { Connection } from './connection';
import { element } from './dom';
import { Meter } from './meter';
import type { Json, MotionKey, ServerMessage, Vec3 } from './protocol';
import { curvesPanel } from './panels/curves';
import { dock } from './panels/dock';
import { Gallery, acceptDrops } from './panels/gallery';
import { Readout } from './panels/readout';
import { SteeringPanel } from './panels/steering';
import { gizmoTarget } from './panels/things';
import { timeline } from './panels/timeline';
import { toasts } from './panels/toasts';
import { Legend, lookBar, toolBar } from './panels/toolbar';
import { topBar } from './panels/topbar';
import { keepCamera, keepLook, restoreCamera, storedLook } from './settings';
import { startShortcuts } from './shortcuts';
import { Store, hasScene } from './store';
import { isDark, onTheme, startTheme } from './theme';
import { download } from './uploads';
import { Throttle } from './throttle';
import type { ViewHandlers } from './view/scene_view';
import { SceneView } from './view/scene_view';

// The cookie that came with the page is what counts from here on.
if (location.search.includes('token=')) history.replaceState(null, '', location.pathname);

startTheme();
const store = new Store(storedLook());
const meter = new Meter();
const socketAddress = `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/api/session`;

const connection: Connection = new Connection(socketAddress, {
    opened: () => {
        view.forgetMeshes();
        store.update({ connection: 'open', frame: null });
        actions.tellLook();
    },
    lost: () => store.update({ connection: 'lost', progress: null }),
    message: receive,
    binary: (message) => view.receive(message),
});
const actions = new Actions(store, connection, () => meter.edited(performance.now(), store.state.status?.step ?? 0));

let gizmoGesture = '';
const sendMotion = new Throttle<{ pointer: string; keys: MotionKey[] }>(34, ({ pointer, keys }) =>
    actions.set([{ set: pointer, value: keys as unknown as Json }], gizmoGesture));

const handlers: ViewHandlers = {
    wants: (event) => store.state.tool === 'grab' || event.ctrlKey || event.metaKey,
    prepare: () => {
        if (store.state.frame !== null) actions.showLive();
        else if (store.state.detail) actions.look({ detail: false });
        else return true;
        store.toast('info', 'This is the level’s own mesh again: grab it now.');
        return false;
    },
    grab: (id, vertex, to) => actions.grab(id, vertex, to),
    letGo: (id, stays) => actions.letGo(id, stays),
    picked: (part) => choosePart(part),
    moved: (pointer, keys, isDone) => {
        if (gizmoGesture === '') gizmoGesture = newGesture();
        sendMotion.push({ pointer, keys });
        if (!isDone) return;
        sendMotion.flush();
        gizmoGesture = '';
    },
    unknownMesh: () => connection.restart(),
    shown: (message) => {
        if (!message.saved) meter.positions(performance.now(), message.step);
        // Others without colours are from before these were asked for.
        if (message.scalars || message.saved) legend.show(message.scalars, message.low, message.high);
        readout.showMeasures({
            volume: view.volume, editShown: meter.editShown, stepsPerSecond: meter.stepsPerSecond(performance.now()),
            vertices: message.positions.length / 3, level: message.level, detail: message.detail,
        });
        restoreCameraOnce();
        host.dataset.step = String(message.step);
        host.dataset.frames = String(Number(host.dataset.frames ?? 0) + 1);
    },
};

/** Turn, tilt, and share of the distance. */
const orbitKeys: Record<string, [number, number, number]> = {
    ArrowLeft: [-0.12, 0, 1], ArrowRight: [0.12, 0, 1], ArrowUp: [0, -0.08, 1], ArrowDown: [0, 0.08, 1],
    '+': [0, 0, 0.9], '-': [0, 0, 1 / 0.9],
};

const sceneName = (): string => store.state.session?.scene?.name ?? '';
let cameraScene = '';

/** Puts the camera where it was before a reload, once the first positions have framed the scene. */
function restoreCameraOnce(): void {
    if (cameraScene === sceneName()) return;
    cameraScene = sceneName();
    restoreCamera(view.stage.camera, view.stage.controls, cameraScene);
}

function choosePart(part: number | null): void {
    const { parts, tool, session } = store.state;
    if (tool !== 'move' && tool !== 'turn') return;
    const name = part === null ? undefined : parts?.parts[part];
    const index = session?.scene?.obstacles.findIndex((obstacle) => obstacle.name === name?.name) ?? -1;
    if (name?.kind === 'obstacle' && index >= 0) store.update({ selected: `/obstacles/${index}` });
}

function receive(message: ServerMessage): void {
    if (message.type === 'sample') meter.step(performance.now());
    if (message.type === 'session') {
        if (message.scene?.name !== store.state.session?.scene?.name) {
            view.clear();
            cameraScene = '';
        }
    }
    const looksBack = store.state.frame !== null;
    if (message.type === 'session' || message.type === 'parts') meter.acknowledged(store.state.status?.step ?? 0);
    store.receive(message);
    // The frame that was looked at is gone: the server still keeps the running state from this page.
    if (looksBack && store.state.frame === null) connection.send({ type: 'frame', index: null });
    if (message.type === 'saved' && message.files.length > 0 && actions.takesExport())
        for (const file of message.files) download(file);
}

const host = element('div', {
    class: 'canvas', role: 'application', tabindex: 0, 'aria-label': 'The scene in three dimensions; arrow keys turn it, plus and minus move nearer and away',
    onkeydown: (event: KeyboardEvent) => {
        const move = orbitKeys[event.key];
        if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        view.stage.orbit(...move);
    },
});
const view: SceneView = new SceneView(host, handlers);
const legend = new Legend(store);
const readout = new Readout(store);
const gallery = new Gallery(store, actions);

const resetCamera = (): void => view.resetCamera();
const openSave = (): void => document.querySelector<HTMLButtonElement>('button[title^="Save the scene"]')?.click();
const showHelp = startShortcuts({ store, actions, resetCamera, openSave });
const studio = element('div', { class: 'studio' },
    element('main', { class: 'view' }, host, toolBar(store, actions), lookBar(store, actions, resetCamera),
        readout.root, legend.root, dock(store, actions)),
    new SteeringPanel(store, actions).root,
    element('footer', { class: 'bottom' }, timeline(store, actions), curvesPanel(store)));
document.getElementById('app')!.append(topBar(store, actions, showHelp), studio, gallery.root, toasts(store));
acceptDrops(actions);
keepLook(store);
keepCamera(view.stage.camera, view.stage.controls, sceneName);

store.watch((state) => [state.gallery, hasScene(state)], (state) => {
    studio.inert = state.gallery || !hasScene(state);
});
store.watch((state) => [state.unusable], (state) => studio.classList.toggle('unusable', state.unusable !== null));
store.watch((state) => [state.parts], (state) => view.setParts(state.parts));
store.watch((state) => [state.edges], (state) => view.setEdges(state.edges));
store.watch((state) => [state.selected, state.tool, state.parts, state.session?.scene, state.frame, state.status?.t, state.unusable], (state) => {
    const isTool = (state.tool === 'move' || state.tool === 'turn') && state.frame === null && !state.unusable;
    view.setGizmo(isTool ? gizmoTarget(state) : null, state.tool === 'turn' ? 'rotate' : 'translate');
});
dropLostColoring(store, (color) => actions.look({ color }));
onTheme(() => view.applyTheme(isDark()));

// What is shown, for tests and for whoever looks behind the page.
Object.assign(window, {
    plisse: {
        positions: () => Array.from(view.shownPositions ?? []), state: () => store.state, seenAt: (place: Vec3) => view.seenAt(place),
    },
});

connection.open();
