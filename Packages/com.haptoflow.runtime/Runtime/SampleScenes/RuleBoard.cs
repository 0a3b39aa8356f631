#nullable enable
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>A line of text that says which rule assigns the material that the pen touches.</summary>
    internal sealed class RuleBoard : MonoBehaviour
    {
        private HapticStylus stylus = null!;
        private TextMesh line = null!;
        private Collider? shown;
        private MaterialDescription? shownMaterial;

        public string Text => line.text;

        public static RuleBoard Create(HapticStylus stylus, Vector3 position, Quaternion rotation)
        {
            TextMesh line = SceneObjects.AddText("", position, rotation);
            line.gameObject.name = "Rule Board";
            var board = line.gameObject.AddComponent<RuleBoard>();
            board.stylus = stylus;
            board.line = line;
            return board;
        }

        private void LateUpdate()
        {
            if (!stylus.IsTouching)
            {
                return;
            }
            HapticContact contact = stylus.Contact;
            // Composing the text allocates, so it happens only when collider or material changes.
            if (!ReferenceEquals(contact.Collider, shown) || !ReferenceEquals(contact.Material, shownMaterial))
            {
                shown = contact.Collider;
                shownMaterial = contact.Material;
                line.text = $"{contact.Collider.name}: {contact.Explain()}";
            }
        }
    }
}
