#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.StylusTracing
{
    /// <summary>A stylus under the mouse: hovers over what the pointer is on, and presses while the button is held.
    /// </summary>
    public sealed class MousePen : MonoBehaviour
    {
        private const float ReachMetres = 10f;
        private const float HoverMetres = 0.03f;

        // A hand's, not a mouse button's.
        private const float LoweringMps = 0.3f;

        // The spring model makes it a force: 1 mm on 1000 N/m is 1 N.
        private const float DeepestMetres = 0.001f;

        private Camera? view;
        private HapticStylus stylus = null!;
        private Vector3 point;
        private Vector3 normal = Vector3.up;
        private float heightMetres = HoverMetres;

        /// <summary>What feels.</summary>
        public HapticStylus Stylus => stylus;

        /// <summary>A pen that follows the mouse as a camera sees it.</summary>
        public static MousePen Create(Camera view)
        {
            var owner = new GameObject("Mouse Pen");
            var pen = owner.AddComponent<MousePen>();
            pen.view = view;
            pen.stylus = owner.AddComponent<HapticStylus>();
            Build.PenBody(owner.transform, new Color(0.2f, 0.2f, 0.22f));
            return pen;
        }

        private void Update()
        {
            if (view == null || !PenInput.TryRead(out Vector2 pixels, out float pressure))
            {
                return;
            }
            Ray ray = view.ScreenPointToRay(new Vector3(pixels.x, pixels.y, 0f));
            bool isOver = Physics.Raycast(ray, out RaycastHit hit, ReachMetres);
            if (isOver)
            {
                point = hit.point;
                normal = hit.normal;
            }
            bool presses = isOver && pressure > 0f;
            float wanted = presses ? stylus.TipRadiusMetres - pressure * DeepestMetres : HoverMetres;
            float step = LoweringMps * Time.unscaledDeltaTime;
            heightMetres += Mathf.Clamp(wanted - heightMetres, -step, step);
            // Leaning towards whoever holds it.
            Vector3 upwards = normal - 0.6f * ray.direction;
            transform.SetPositionAndRotation(
                point + heightMetres * normal, Quaternion.FromToRotation(Vector3.up, upwards));
        }
    }
}
