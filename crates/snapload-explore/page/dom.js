// The page's elements by their ids, and updates of them.

/**
 * @param {string} id
 * @returns {any} The caller knows the kind of element.
 */
export const $ = (id) => document.getElementById(id);

/**
 * Sets the properties of an element that differ from their current values: writing a property causes a new layout, even
 * with the same value.
 * @param {any} element
 * @param {object} properties
 */
export function setProperties(element, properties) {
  for (const [name, value] of Object.entries(properties)) if (element[name] !== value) element[name] = value;
}

/**
 * The same for attributes; null removes one.
 * @param {Element} element
 * @param {object} attributes
 */
export function setAttributes(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null) element.removeAttribute(name);
    else if (element.getAttribute(name) !== value) element.setAttribute(name, value);
  }
}
