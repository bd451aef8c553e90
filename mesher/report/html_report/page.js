// A link to the page may say how to look at the mesh: report.html#cut=x,0.4&colour=region&turn=30&worst=0
'use strict';

async function follow(link, view, shown) {
  const wishes = new URLSearchParams(link.replace(/^#/, ''));
  const set = (id, value) => { document.getElementById(id).value = value; };
  if (wishes.has('colour')) set('colour', wishes.get('colour'));
  if (wishes.has('cut')) {
    const [axis, position] = wishes.get('cut').split(',');
    set('axis', axis);
    if (position && shown.complete) set('position', position);
  }
  if (wishes.has('colour') || wishes.has('cut')) view.rebuild();
  if (wishes.has('turn')) view.turn(Number(wishes.get('turn')));
  if (wishes.has('step')) await view.showStep(Number(wishes.get('step')));
  const worst = shown.worst[Number(wishes.get('worst') ?? -1)];
  if (worst) view.show(worst.where, worst.tet);
}

async function open() {
  const json = id => JSON.parse(document.getElementById(id).textContent);
  const report = json('report'), shown = json('shown');
  let view = null;
  const names = namesOf(report);
  describe(report, shown, names, (where, tet) => { if (view) view.show(where, tet); });
  if (typeof THREE === 'undefined' || shown.tets + shown.faces === 0) {
    document.getElementById('view').remove();
    return;
  }
  const mesh = await readMesh(shown, document.getElementById('data').textContent);
  mesh.colours = coloursOf(report, shown);
  mesh.layers = layersOf(report, shown);
  view = new View(shown, mesh, names, report.second_order ? report.second_order.straightened : []);
  view.offerSteps(json('steps'));
  await follow(location.hash, view, shown);
  window.addEventListener('hashchange', () => follow(location.hash, view, shown));
}

window.addEventListener('error', event => { document.body.dataset.error = event.message; });
open().then(() => { document.body.dataset.ready = 'yes'; }, error => {
  document.body.dataset.error = error.message;
  document.getElementById('selected').textContent = `The view cannot be shown: ${error.message}`;
});
