#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Base class of a component that builds a whole scene by script when it wakes, as the package's samples
    /// do. It holds the camera, and a model for projects whose settings name none.</summary>
    [RequireComponent(typeof(PipelineMaterial))]
    public abstract class BuiltScene : MonoBehaviour
    {
        [SerializeField, Tooltip("The model is used when Project Settings > HaptoFlow names none.")]
        private HapticModelAsset? model;

        [SerializeField, Tooltip("The camera shows the scene, and the mouse pen points through it.")]
        private Camera? view;

        /// <summary>The model that is used when the project's settings name none. Set it before the component wakes.
        /// </summary>
        public HapticModelAsset? Model { get => model; set => model = value; }

        /// <summary>The scene's camera. Set it before the component wakes.</summary>
        public Camera? View { get => view; set => view = value; }

        /// <summary>Draws in the scene view what the scene will build. It is called before play mode only; use
        /// <see cref="SceneSketch"/>.</summary>
        public abstract void Sketch();

        /// <summary>The labels of the model in use, before play mode too; none without a model.</summary>
        protected IReadOnlyList<HapticLabel> LabelsOfModel()
        {
            HapticModelAsset? used = HaptoFlowSettings.Active.Model != null ? HaptoFlowSettings.Active.Model : model;
            return used != null ? used.Header.Labels : Array.Empty<HapticLabel>();
        }

        private void OnDrawGizmos()
        {
            if (!Application.isPlaying)
            {
                Sketch();
            }
        }

        /// <summary>Gives the project's settings the scene's model if they name none.</summary>
        protected void UseModelIfNoneIsSet()
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            if (settings.Model == null)
            {
                settings.Model = model;
            }
        }
    }
}
