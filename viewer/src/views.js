// The choice of sides to see something from, and the view of the beginning.
import { byId } from './buttons.js';
import { sides } from './directions.js';
import { element } from './element.js';

// The choice names a side until the view is turned.
export function addViews(view, space) {
  const choice = byId('views');
  const offered = sides(space);
  choice.append(element('option', { value: '' }, 'View'), ...offered.map(({ name }, value) => element('option', { value }, name)));
  choice.addEventListener('change', () => {
    if (choice.value !== '') view.lookFrom(offered[choice.value].direction);
  });
  view.onTurn = () => { choice.value = ''; };
  byId('reset').addEventListener('click', () => {
    choice.value = '';
    view.reset();
  });
}
