#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Shows which label a stylus touches, how fast and how hard, or why there are no haptics. Until it plays,
    /// it shows what its Text Mesh says.</summary>
    [AddComponentMenu("HaptoFlow/Status Board")]
    [RequireComponent(typeof(TextMesh))]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "status-board")]
    public sealed class StatusBoard : MonoBehaviour
    {
        // Every new text allocates; four a second are enough to read.
        private const double UpdateSeconds = 0.25;

        [SerializeField, Tooltip("The board shows what this stylus touches. With a rig, it may be empty.")]
        private HapticStylus? stylus;

        [SerializeField, Tooltip("The board shows what the pen in use of this rig touches. When it is empty, the board " +
            "shows the stylus above.")]
        private XrRig? rig;

        [SerializeField, Tooltip("The board shows this text while nothing is touched.")]
        private string idleText = "";

        private TextMesh? mesh;
        private double nextUpdateSeconds;

        /// <summary>The text that the board shows.</summary>
        public string Text => Mesh.text;

        /// <summary>The rig whose pen in use the board shows; null for one stylus.</summary>
        public XrRig? Rig { get => rig; set => rig = value; }

        private TextMesh Mesh => mesh != null ? mesh : mesh = GetComponent<TextMesh>();

        /// <summary>Creates a board. Main thread, in play mode.</summary>
        /// <param name="idleText">The text that is shown while the stylus touches nothing.</param>
        public static StatusBoard Create(HapticStylus stylus, string idleText, Vector3 position, Quaternion rotation)
        {
            TextMesh text = SceneObjects.AddText(idleText, position, rotation);
            var board = text.gameObject.AddComponent<StatusBoard>();
            board.stylus = stylus;
            board.idleText = idleText;
            return board;
        }

        private void Update()
        {
            if (Time.unscaledTimeAsDouble < nextUpdateSeconds)
            {
                return;
            }
            nextUpdateSeconds = Time.unscaledTimeAsDouble + UpdateSeconds;
            Mesh.text = Haptics.Problem ?? (Haptics.IsReady ? DescribeTouch() : "the model is being loaded");
        }

        private string DescribeTouch()
        {
            HapticStylus? shown = rig != null ? rig.PenInUse : stylus;
            if (shown == null || !shown.IsTouching)
            {
                return idleText;
            }
            HapticContact contact = shown.Contact;
            float speedMps = contact.TangentialVelocity.magnitude;
            return FormattableString.Invariant(
                $"{contact.Material?.Label}: {speedMps:0.00} m/s, {contact.ForceNewtons:0.0} N");
        }
    }
}
