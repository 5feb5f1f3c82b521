// The page's elements: by their ids, and what is written into them.

/**
 * @param {string} id
 * @returns {any} Which kind of element it is is known where it is asked for.
 */
export const $ = (id) => document.getElementById(id);

/**
 * Sets properties of an element that are others than they were: what is written anew has the page laid out again, even
 * where it is the same.
 * @param {any} element
 * @param {object} properties
 */
export function setProperties(element, properties) {
  for (const [name, value] of Object.entries(properties)) if (element[name] !== value) element[name] = value;
}

/**
 * The same of attributes; null takes one away.
 * @param {Element} element
 * @param {object} attributes
 */
export function setAttributes(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null) element.removeAttribute(name);
    else if (element.getAttribute(name) !== value) element.setAttribute(name, value);
  }
}
