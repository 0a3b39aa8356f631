#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A stylus under the mouse or a graphics pen: it hovers over the object under the pointer and presses
    /// while the button is held or the pen touches its tablet.</summary>
    [AddComponentMenu("HaptoFlow/Mouse Pen")]
    [RequireComponent(typeof(HapticStylus))]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "mouse-pen")]
    public sealed class MousePen : MonoBehaviour
    {
        // The speed of a hand; a mouse button would be instantaneous.
        private const float LoweringMps = 0.3f;

        [SerializeField, Tooltip("The camera of the pointer. Leave it empty for the scene's main camera.")]
        private Camera? view;

        [SerializeField, Min(0f), Tooltip("The maximum distance of objects from the camera, in metres.")]
        private float reachMetres = 10f;

        [SerializeField, Min(0f), Tooltip("The height of the tip above the surface while nothing is pressed, in " +
            "metres.")]
        private float hoverMetres = 0.03f;

        [SerializeField, Min(0f), Tooltip("The penetration depth at full pressure, in metres. With the spring model, " +
            "0.001 m at 1000 N/m gives 1 N.")]
        private float depthMetres = 0.001f;

        private HapticStylus? stylus;
        private Vector3 point;
        private Vector3 normal = Vector3.up;
        private float heightMetres;
        private bool warned;

        /// <summary>The stylus on this object.</summary>
        public HapticStylus Stylus => stylus != null ? stylus : stylus = GetComponent<HapticStylus>();

        /// <summary>The camera of the pointer; null for the scene's main camera.</summary>
        public Camera? View { get => view; set => view = value; }

        /// <summary>Maximum distance of objects from the camera, in metres; 0 or more.</summary>
        public float ReachMetres { get => reachMetres; set => reachMetres = Mathf.Max(0f, value); }

        /// <summary>Height of the tip above the surface while nothing is pressed, in metres; 0 or more.</summary>
        public float HoverMetres { get => hoverMetres; set => hoverMetres = Mathf.Max(0f, value); }

        /// <summary>Penetration depth at full pressure, in metres; 0 or more.</summary>
        public float DepthMetres { get => depthMetres; set => depthMetres = Mathf.Max(0f, value); }

        /// <summary>Creates a pen with stylus and body. Main thread, also in edit mode.</summary>
        /// <param name="view">Null for the scene's main camera.</param>
        public static MousePen Create(Camera? view)
        {
            var owner = new GameObject("Mouse Pen");
            owner.AddComponent<HapticStylus>().Tip = owner.transform;
            var pen = owner.AddComponent<MousePen>();
            pen.view = view;
            PenBody.Add(owner.transform, new Color(0.2f, 0.2f, 0.22f));
            return pen;
        }

        private void OnEnable() => heightMetres = hoverMetres;

        private void Update()
        {
            Camera? camera = view != null ? view : Camera.main;
            if (camera == null)
            {
                WarnOfNoCamera();
                return;
            }
            if (!PenInput.TryRead(out Vector2 pixels, out float pressure))
            {
                return;
            }
            Ray ray = camera.ScreenPointToRay(new Vector3(pixels.x, pixels.y, 0f));
            // Query only what the stylus can touch: no triggers, and only its layers.
            bool isOver = gameObject.scene.GetPhysicsScene().Raycast(ray.origin, ray.direction, out RaycastHit hit,
                reachMetres, Stylus.Layers, QueryTriggerInteraction.Ignore);
            if (isOver)
            {
                point = hit.point;
                normal = hit.normal;
            }
            bool presses = isOver && pressure > 0f;
            float wanted = presses ? Stylus.TipRadiusMetres - pressure * depthMetres : hoverMetres;
            float step = LoweringMps * Time.unscaledDeltaTime;
            heightMetres += Mathf.Clamp(wanted - heightMetres, -step, step);
            // Tilt the pen towards the viewer.
            Vector3 upwards = normal - 0.6f * ray.direction;
            transform.SetPositionAndRotation(
                point + heightMetres * normal, Quaternion.FromToRotation(Vector3.up, upwards));
        }

        private void WarnOfNoCamera()
        {
            if (!warned)
            {
                warned = true;
                Debug.LogWarning("HaptoFlow: a Mouse Pen has no camera to point through: give it one in its field " +
                    "View, or tag the scene's camera MainCamera.", this);
            }
        }
    }
}
